# scintray_precompile(TARGET KIND [HEADERS headers] [LINK libraries]) lets TARGET use headers that are compiled once for
# all targets of one KIND, where the option SCINTRAY_PRECOMPILE is on: those below and HEADERS, which need LINK. All
# targets of a kind have the same compiler options; a compiler refuses headers that it compiled with others. Headers of
# ours are never among them, so that a file which lacks an include of ours fails here as well; tools/includes finds what
# lacks one of the standard library.
option(SCINTRAY_PRECOMPILE "Compile once what most files include of the standard library and third parties" OFF)

function(scintray_precompile target kind)
  if(NOT SCINTRAY_PRECOMPILE)
    return()
  endif()
  cmake_parse_arguments(KIND "" "" "HEADERS;LINK" ${ARGN})
  set(owner scintray_headers_${kind})
  if(NOT TARGET ${owner})
    add_library(${owner} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
    get_target_property(options ${target} COMPILE_OPTIONS)
    get_target_property(not_in_threads ${target} SCINTRAY_NOT_IN_THREADS)
    get_target_property(independent ${target} POSITION_INDEPENDENT_CODE)
    set_target_properties(${owner} PROPERTIES UNITY_BUILD OFF SCINTRAY_NOT_IN_THREADS "${not_in_threads}")
    if(independent)
      set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    if(options)
      target_compile_options(${owner} PRIVATE ${options})
    endif()
    target_link_libraries(${owner} PRIVATE scintray_options Eigen3::Eigen fmt::fmt ${KIND_LINK})
    target_precompile_headers(${owner} PRIVATE <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <complex>
      <cstdint> <cstring> <deque> <filesystem> <fstream> <functional> <iostream> <limits> <map> <memory> <mutex> <numeric>
      <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <thread> <unordered_map> <utility> <variant>
      <vector> <Eigen/Geometry> <fmt/format.h> ${KIND_HEADERS})
  endif()
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)  # its macros are in the headers
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# GCC 12 at -O3 warns of the standard library's own code where that is precompiled (std::string::insert).
if(SCINTRAY_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(scintray_options INTERFACE $<BUILD_INTERFACE:-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds>)
endif()

# What ccache asks for: it keeps what was compiled with such headers only so (its manual, "Precompiled headers").
if(SCINTRAY_PRECOMPILE AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(scintray_options INTERFACE $<BUILD_INTERFACE:-fpch-preprocess>)
  else()
    target_compile_options(scintray_options INTERFACE "$<BUILD_INTERFACE:SHELL:-Xclang -fno-pch-timestamp>")
  endif()
endif()
