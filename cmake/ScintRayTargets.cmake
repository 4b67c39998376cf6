# scintray_module(NAME [NOT_TRACING | PREPARING] [NOT_IN_THREADS] [LINK modules and libraries] [PRIVATE_LINK libraries]
# [WITHOUT sources] [JOIN number]) makes the static library scintray_NAME of every source of src/scintray/NAME, less those of WITHOUT.
# Headers are included as "scintray/NAME/header.hpp", their path below src/; those in a folder called detail are not
# installed. Where sources are joined, JOIN of them are (12, or 24 where they are
# NOT_TRACING or PREPARING; what all of them include is compiled once for each join).
# A module named in SCINTRAY_APART is compiled file by file all the same: for daily work on it.
# NOT_TRACING: the module reads, writes and prints, and a release of it is compiled in less time, with -O1; where a
# sanitizer is added, without optimisation.
# PREPARING: the module prepares, directs or evaluates what is traced; the same for a release, but optimised where a sanitizer is added.
# NOT_IN_THREADS: in the tests of what runs on many threads one thread alone runs it, before or after the others; the
# thread sanitizer is left out of it.
add_library(scintray_options INTERFACE)
target_compile_features(scintray_options INTERFACE cxx_std_20)
target_compile_options(scintray_options INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual>
  # GCC 12 takes temporaries of a throw expression for uninitialised, and "literal" + std::string for
  # overlapping memory (its bugs 105562 and 105651).
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-restrict>>
  # More is allocated before the compiler looks for garbage of its own, which takes a twelfth of its time.
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=500000 --param ggc-min-expand=100>>
  # Clang takes names of two files of one join for shadowing; its build of each file by itself looks for the others.
  $<BUILD_INTERFACE:$<$<AND:$<CXX_COMPILER_ID:Clang>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-shadow>>
  # A product and a sum are two operations everywhere: results have the same bits on every processor.
  $<BUILD_INTERFACE:-ffp-contract=off>
  # Nothing here asks errno about a square root.
  $<BUILD_INTERFACE:-fno-math-errno>
  # No other library replaces a function of this one.
  $<BUILD_INTERFACE:-fno-semantic-interposition>
  $<BUILD_INTERFACE:$<$<BOOL:${SCINTRAY_WERROR}>:-Werror>>)
if(SCINTRAY_SANITIZE STREQUAL "address")
  # Of undefined behaviour, what the address sanitizer does not find by itself: tests of each pointer before it is used
  # would take a third of the time of compiling.
  target_compile_options(scintray_options INTERFACE
    $<BUILD_INTERFACE:-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer>
    $<BUILD_INTERFACE:-fno-sanitize=alignment,nonnull-attribute,null,object-size,pointer-overflow,returns-nonnull-attribute,vptr>)
  target_link_options(scintray_options INTERFACE $<BUILD_INTERFACE:-fsanitize=address,undefined>)
elseif(SCINTRAY_SANITIZE STREQUAL "thread")
  # This is also the build by clang of each file: what one thread runs by itself is compiled without the sanitizer.
  target_compile_options(scintray_options INTERFACE
    $<BUILD_INTERFACE:$<IF:$<BOOL:$<TARGET_PROPERTY:SCINTRAY_NOT_IN_THREADS>>,-O0;-g0,-fsanitize=thread>>)
  target_link_options(scintray_options INTERFACE $<BUILD_INTERFACE:-fsanitize=thread>)
elseif(SCINTRAY_SANITIZE)
  message(FATAL_ERROR "SCINTRAY_SANITIZE is \"${SCINTRAY_SANITIZE}\"; it may be address, thread or empty")
endif()
if(SCINTRAY_SANITIZE)
  # For files of large templates: optimising what the sanitizers add to them takes half of the time.
  set(scintray_slow_to_compile -O0)
endif()
include(ScintRayPrecompile)
if(SCINTRAY_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "SCINTRAY_FUZZ needs clang, whose libFuzzer it uses: -DCMAKE_CXX_COMPILER=clang++")
  endif()
  target_compile_options(scintray_options INTERFACE
    $<BUILD_INTERFACE:-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined>)
  target_link_options(scintray_options INTERFACE $<BUILD_INTERFACE:-fsanitize=address,undefined>)
endif()

# Kernels for the lanes of vector registers: NAME_2.cpp, NAME_4.cpp and NAME_8.cpp are compiled for SSE2, AVX2 and
# AVX-512. Other processors than x86-64 have none: `without` is then what scintray_module() has to leave out.
function(scintray_lanes without)
  set(${without} PARENT_SCOPE)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(${without} WITHOUT ${ARGN} PARENT_SCOPE)
    return()
  endif()
  # Of xsimd its headers alone: the target also links a library that only its complex numbers need.
  include_directories(SYSTEM $<TARGET_PROPERTY:xsimd,INTERFACE_INCLUDE_DIRECTORIES>)
  foreach(kernel IN LISTS ARGN)
    set_source_files_properties(${kernel} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
    if(kernel MATCHES "_4.cpp$")
      set(options -mavx2 -mbmi -mbmi2)
      set(bits 256)
    elseif(kernel MATCHES "_8.cpp$")
      # GCC 12 takes its own intrinsics of AVX-512 for uninitialised.
      set(options -mavx512f -mbmi -mbmi2 -Wno-uninitialized)
      set(bits 512)
    else()
      continue()
    endif()
    # By default GCC copies structures in pieces of 16 bytes; the load of a whole vector after such stores waits
    # until they have left the store buffer.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
      list(APPEND options -mmove-max=${bits} -mstore-max=${bits})
    endif()
    set_source_files_properties(${kernel} PROPERTIES COMPILE_OPTIONS "${options}")
  endforeach()
endfunction()

function(scintray_module name)
  cmake_parse_arguments(MODULE "NOT_TRACING;PREPARING;NOT_IN_THREADS" "JOIN" "LINK;PRIVATE_LINK;WITHOUT" ${ARGN})
  if(MODULE_PREPARING AND NOT SCINTRAY_SANITIZE)
    set(MODULE_NOT_TRACING TRUE)
  endif()
  if(NOT MODULE_JOIN)
    set(MODULE_JOIN 12)
    if(MODULE_NOT_TRACING OR MODULE_PREPARING)
      set(MODULE_JOIN 24)
    endif()
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  foreach(source IN LISTS MODULE_WITHOUT)
    if(NOT source IN_LIST sources)
      message(FATAL_ERROR "scintray_module(${name} WITHOUT ${source}): there is no such file")
    endif()
    list(REMOVE_ITEM sources ${source})
  endforeach()
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS *.hpp)
  set(internal_headers ${headers})
  # core/lanes/ is for the kernels of several modules, and includes xsimd.
  list(FILTER headers EXCLUDE REGEX "/detail/|/core/lanes/")
  list(FILTER internal_headers INCLUDE REGEX "/detail/|/core/lanes/")
  set(target scintray_${name})
  add_library(${target} STATIC ${sources})
  add_library(scintray::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON UNITY_BUILD_BATCH_SIZE ${MODULE_JOIN})
  if(name IN_LIST SCINTRAY_APART)
    set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  endif()
  if(MODULE_NOT_TRACING)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> ${scintray_slow_to_compile})
  endif()
  if(MODULE_NOT_IN_THREADS AND SCINTRAY_SANITIZE STREQUAL "thread")
    set_target_properties(${target} PROPERTIES SCINTRAY_NOT_IN_THREADS ON)
    scintray_precompile(${target} not_in_threads)
  elseif(MODULE_NOT_TRACING)
    scintray_precompile(${target} not_tracing)
  else()
    scintray_precompile(${target} tracing)
  endif()
  target_sources(${target}
    PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${headers}
    PRIVATE FILE_SET internal TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${internal_headers})
  target_link_libraries(${target} PUBLIC scintray_options ${MODULE_LINK} PRIVATE ${MODULE_PRIVATE_LINK})
  set_property(GLOBAL APPEND PROPERTY SCINTRAY_LIBRARIES ${target})
endfunction()
