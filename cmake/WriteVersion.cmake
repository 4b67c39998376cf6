# Run at every build: writes version.cpp with the release and the git revision of the source tree.
# The file is touched only when its content changes, so that nothing is compiled anew for nothing.
#   cmake -DSOURCE=... -DRELEASE=... -DINPUT=version.cpp.in -DOUTPUT=version.cpp -P WriteVersion.cmake
set(SCINTRAY_RELEASE ${RELEASE})
set(SCINTRAY_VERSION ${RELEASE})
if(EXISTS ${SOURCE}/.git)
  execute_process(
    COMMAND git -C ${SOURCE} describe --always --dirty=.modified --abbrev=12 --exclude=*
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status ERROR_QUIET)
  if(status EQUAL 0)
    set(SCINTRAY_VERSION "${RELEASE}+g${revision}")
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
