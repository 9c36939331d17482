// Runs the tests of a program. Methods of one's own that cannot be loaded end it with 2, as they
// end driftless itself.

#include <gtest/gtest.h>

#include <iostream>

#include "integrators/modules.hpp"

int main(int argc, char** argv) {
  try {
    driftless::load_methods_of_environment();
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
  } catch (const driftless::ModuleError& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 2;
  }
}
