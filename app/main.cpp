// The program `polder`: everything is in run_program(), so that tests can call it.
#include <iostream>
#include <string>
#include <vector>

#include "app/program.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  return polder::app::run_program(words, std::cout, std::cerr);
}
