# cmake --install: libraries, headers, program, data, and the package that find_package(ScintRay) reads. Two
# components: program, and development for programs of one's own.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ScintRay)

# scintray::scintray is everything a program may use: all modules but the command line.
get_property(libraries GLOBAL PROPERTY SCINTRAY_LIBRARIES)
add_library(scintray INTERFACE)
add_library(scintray::scintray ALIAS scintray)
target_link_libraries(scintray INTERFACE ${libraries})
set_target_properties(scintray_options PROPERTIES EXPORT_NAME options)

install(TARGETS scintray scintray_options ${libraries} EXPORT ScintRayTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
if(TARGET scintray_cli)
  install(TARGETS scintray_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  # The program writes its own manual pages and completions, from the same text as its help.
  install(CODE "
    set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share\")
    set(scintray \"$<TARGET_FILE:scintray_cli>\")
    file(MAKE_DIRECTORY \"\${share}/bash-completion/completions\" \"\${share}/fish/vendor_completions.d\"
      \"\${share}/zsh/vendor-completions\")
    execute_process(COMMAND \"\${scintray}\" manual \"\${share}/man/man1\" OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"\${scintray}\" completion bash
      OUTPUT_FILE \"\${share}/bash-completion/completions/scintray\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"\${scintray}\" completion zsh
      OUTPUT_FILE \"\${share}/zsh/vendor-completions/_scintray\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"\${scintray}\" completion fish
      OUTPUT_FILE \"\${share}/fish/vendor_completions.d/scintray.fish\" COMMAND_ERROR_IS_FATAL ANY)
  " COMPONENT program)
endif()
install(DIRECTORY materials scenes geometry DESTINATION share/scintray COMPONENT program)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION share/doc/scintray COMPONENT program)

install(EXPORT ScintRayTargets NAMESPACE scintray:: DESTINATION ${package_folder}
  COMPONENT development)
configure_package_config_file(cmake/ScintRayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ScintRayConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ScintRayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ScintRayConfig.cmake ${PROJECT_BINARY_DIR}/ScintRayConfigVersion.cmake
  third_party/dependencies.cmake cmake/FindXraylib.cmake DESTINATION ${package_folder}
  COMPONENT development)
