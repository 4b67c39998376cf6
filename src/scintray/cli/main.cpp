/// The program: `scintray COMMAND ...`. Each command is in a file of its own.

#include <iostream>

#include "scintray/cli/commands.hpp"

int main(int argc, char** argv) {
  return scintray::cli::run_program(scintray::cli::commands(), argc, argv, std::cout, std::cerr);
}
