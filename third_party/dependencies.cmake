# What the libraries are built on. Every dependency is a Debian package found here and nowhere else;
# third_party/README.md says which package, version and licence each is, and what it is used for.
#
# The same list serves this build, where scintray_dependency is find_package(... REQUIRED), and the
# installed package, where it is find_dependency(...).
scintray_dependency(Eigen3 3.4 NO_MODULE)
scintray_dependency(Threads)
scintray_dependency(TBB)
scintray_dependency(embree)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE ON)
scintray_dependency(CGAL 5.5)
scintray_dependency(assimp 5.2)
scintray_dependency(TinyGLTF)
scintray_dependency(toml11 3.7)
scintray_dependency(fmt 9)
scintray_dependency(HDF5 COMPONENTS C HL)
scintray_dependency(ZLIB)
scintray_dependency(libzip 1.7)
scintray_dependency(pugixml 1.13)
scintray_dependency(muparser 2.3)
scintray_dependency(PNG)
scintray_dependency(Xraylib)
scintray_dependency(Boost 1.74)
scintray_dependency(GSL 2.7)
scintray_dependency(nlohmann_json 3)

# Reads STEP. The build does without it where it is missing, unless told to insist with SCINTRAY_STEP=ON.
if(SCINTRAY_STEP)
  scintray_dependency(OpenCASCADE)  # its version file accepts no version but its own exact one
endif()

# embree's own version file accepts no other major number than its own; 3 and 4 both serve.
if(EMBREE_VERSION VERSION_LESS 3.13)
  message(FATAL_ERROR "Embree ${EMBREE_VERSION} was found; ScintRay needs 3.13 or newer (libembree-dev)")
endif()
