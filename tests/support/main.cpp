#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#ifdef SCINTRAY_SANITIZED
// What libraries keep when they give up on a file: Open CASCADE's registries, assimp's importers, the
// message of xraylib's parser of formulae.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libTK\nleak:libassimp\nleak:libxrl\n"; }
#endif
