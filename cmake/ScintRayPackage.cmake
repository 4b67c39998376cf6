# cpack: Debian packages of the components that ScintRayInstall.cmake and src/python name. tools/package runs it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME scintray)
set(CPACK_PACKAGE_CONTACT "The ScintRay developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_INSTALL_DIRECTORY scintray)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

set(CPACK_COMPONENTS_ALL program development)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "The program scintray, its materials and example scenes.\n It follows scintillation light through radiation detectors whose parts are\n arbitrary triangle meshes, with surfaces computed from measured height maps.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME scintray)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)  # what the program links, found by dpkg-shlibdeps

# Static libraries and headers: who links them needs what they were built with.
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Headers, static libraries and CMake package of ScintRay, for programs of\n one's own.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libscintray-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  libassimp-dev libboost-dev libcgal-dev libeigen3-dev libembree-dev libfmt-dev libgsl-dev libhdf5-dev libmuparser-dev
  libpng-dev libpugixml-dev libtbb-dev libtinygltf-dev libtoml11-dev libxrl-dev libzip-dev zipcmp zipmerge ziptool
  nlohmann-json3-dev zlib1g-dev)
if(SCINTRAY_STEP)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    ", libocct-data-exchange-dev, libocct-modeling-algorithms-dev, libfontconfig-dev")
endif()
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS program)  # its CMake package reads the same materials

# The Python module, for the Python of this Debian.
if(SCINTRAY_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "The Python module scintray.\n Scenes loaded or built in code, runs in memory, results as NumPy arrays, plots.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-scintray)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_python_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_python_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas, python3-xarray")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_PYTHON_DEPENDS program)  # it reads the same materials
endif()
include(CPack)
