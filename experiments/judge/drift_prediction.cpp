#include "experiments/judge/drift_prediction.hpp"

#include <Eigen/Dense>

namespace driftless::judge {
namespace {

/// Psi'' in Cartesian coordinates: 3N x 3N.
Eigen::MatrixXd hessian(System& system) {
  const auto& fluid = system.fluid();
  const auto size = static_cast<Eigen::Index>(3 * system.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  system.for_each_pair([&](const System::Geometry& pair) {
    const double across = -fluid.repulsive_force(pair.r) / pair.r;  // psi'/r
    const double along = fluid.potential_laplacian(pair.r) - 2 * across;
    const Eigen::Matrix3d block =
        across * Eigen::Matrix3d::Identity() + (along - across) * pair.e * pair.e.transpose();
    const Eigen::Index i = 3 * static_cast<Eigen::Index>(pair.i),
                       j = 3 * static_cast<Eigen::Index>(pair.j);
    matrix.block<3, 3>(i, i) += block;
    matrix.block<3, 3>(j, j) += block;
    matrix.block<3, 3>(i, j) -= block;
    matrix.block<3, 3>(j, i) -= block;
  });
  return matrix;
}

}  // namespace

DriftPrediction predicted_drift(System& system) {
  const auto& fluid = system.fluid();
  const auto& parameters = fluid.parameters();
  const Eigen::MatrixXd curvature = hessian(system);
  // With v Maxwellian, <(e.[(Psi'' v)_i - (Psi'' v)_j])^2> = kT/m |e^T (Psi''_i - Psi''_j)|^2, and
  // Gamma^2/2kT = zeta_0 w where the temperature is the mean one.
  double sum = 0;
  system.for_each_pair([&](const System::Geometry& pair) {
    const Eigen::Index i = 3 * static_cast<Eigen::Index>(pair.i),
                       j = 3 * static_cast<Eigen::Index>(pair.j);
    const Eigen::RowVectorXd row =
        pair.e.transpose() * (curvature.middleRows<3>(i) - curvature.middleRows<3>(j));
    sum += parameters.friction * pair.w_friction * row.squaredNorm();
  });
  const double mass_cubed = std::pow(fluid.mass(), 3);
  const double scale = sum / (mass_cubed * static_cast<double>(system.size()));
  return {scale / 36, scale / 144};
}

}  // namespace driftless::judge
