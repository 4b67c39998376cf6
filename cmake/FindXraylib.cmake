# Finds xraylib (https://github.com/tschoonj/xraylib), whose package has no CMake file of its own: Xraylib::Xraylib.
find_path(XRAYLIB_INCLUDE_FOLDER xraylib/xraylib.h)
find_library(XRAYLIB_LIBRARY xrl)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Xraylib
  REASON_FAILURE_MESSAGE "install libxrl-dev" REQUIRED_VARS XRAYLIB_LIBRARY XRAYLIB_INCLUDE_FOLDER)
mark_as_advanced(XRAYLIB_INCLUDE_FOLDER XRAYLIB_LIBRARY)
if(Xraylib_FOUND AND NOT TARGET Xraylib::Xraylib)
  add_library(Xraylib::Xraylib UNKNOWN IMPORTED)
  set_target_properties(Xraylib::Xraylib PROPERTIES
    IMPORTED_LOCATION ${XRAYLIB_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${XRAYLIB_INCLUDE_FOLDER})
endif()
