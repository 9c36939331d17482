#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "model/coefficient_law.hpp"

// What is needed to write the law of a coefficient: Differentiable has the arithmetic of a double,
// and abs, sqrt, exp, log, sin, cos, tanh, ..., and pow with a plain exponent. Sums and products
// are of Eigen's own types, which refer to their parts: name `Differentiable`, not `auto`, what is
// kept.
