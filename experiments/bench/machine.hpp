#pragma once

#include <string>

/// What the bench tells of the machine.
namespace driftless {

/// The best vector instructions of this machine, as Highway names them.
std::string instruction_set();

/// How many CPUs this process may run on.
unsigned usable_cpus();

}  // namespace driftless
