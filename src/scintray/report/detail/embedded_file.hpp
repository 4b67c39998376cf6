#pragma once
/// Files inside the program.

// The file at `path` as an array of the program: between NAME and NAME_end. A macro, because the assembler
// reads the file.
#define SCINTRAY_EMBED(name, path)                                                                    \
  __asm__(".pushsection .rodata\n.global " #name "\n" #name ":\n.incbin \"" path "\"\n.global " #name \
          "_end\n" #name "_end:\n.byte 0\n.popsection\n");                                            \
  extern "C" const char name[], name##_end[]
