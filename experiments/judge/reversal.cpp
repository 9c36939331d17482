#include "experiments/judge/reversal.hpp"

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "experiments/judge/conclusion.hpp"

namespace driftless::judge {

using Eigen::Index;

Eigen::VectorXd reversal_differences(const Eigen::MatrixXd& series,
                                     const std::vector<MomentPair>& pairs,
                                     const std::vector<int>& lags) {
  Eigen::VectorXd differences(static_cast<Index>(pairs.size() * lags.size()));
  Index n = 0;
  for (const int lag : lags) {
    const Index times = series.rows() - lag;
    for (const auto& pair : pairs) {
      const auto f = series.col(pair.f), g = series.col(pair.g);
      const double forwards = f.head(times).dot(g.tail(times));
      const double backwards = g.head(times).dot(f.tail(times));
      differences[n++] = (forwards - pair.sign * backwards) / static_cast<double>(times);
    }
  }
  return differences;
}

void Scatter::add(const Eigen::VectorXd& row) {
  if (rows_ == 0) {
    sum_.setZero(row.size());
    products_.setZero(row.size(), row.size());
  }
  ++rows_;
  sum_ += row;
  products_.selfadjointView<Eigen::Lower>().rankUpdate(row);
}

nlohmann::json Scatter::record() const {
  nlohmann::json mean = nlohmann::json::array(), covariance = nlohmann::json::array();
  for (Index i = 0; i < sum_.size(); ++i) {
    mean.push_back(sum_[i] / rows_);
    auto& row = covariance.emplace_back(nlohmann::json::array());
    for (Index j = 0; j <= i; ++j) {
      const double scatter = products_(i, j) - sum_[i] * sum_[j] / rows_;
      row.push_back(scatter / (rows_ - 1) / rows_);
    }
  }
  return {{"rows", rows_}, {"mean", mean}, {"covariance", covariance}};
}

MeasuredVector measured_vector(const nlohmann::json& record) {
  const auto size = static_cast<Index>(record["mean"].size());
  MeasuredVector vector{record["rows"], Eigen::VectorXd(size), Eigen::MatrixXd(size, size)};
  for (Index i = 0; i < size; ++i) {
    vector.mean[i] = record["mean"][i];
    for (Index j = 0; j <= i; ++j) {
      vector.covariance(i, j) = vector.covariance(j, i) = record["covariance"][i][j].get<double>();
    }
  }
  return vector;
}

MeasuredVector at_vanishing_step(const std::array<MeasuredVector, 3>& vectors) {
  constexpr std::array<double, 3> weights = {1.0 / 3, -2, 8.0 / 3};
  MeasuredVector limit{vectors[0].rows, 0 * vectors[0].mean, 0 * vectors[0].covariance};
  for (std::size_t n = 0; n < 3; ++n) {
    limit.rows = std::min(limit.rows, vectors[n].rows);
    limit.mean += weights[n] * vectors[n].mean;
    limit.covariance += weights[n] * weights[n] * vectors[n].covariance;
  }
  return limit;
}

bool ChanceTest::certainly_not_chance() const {
  const double allowed = 2 * cdf(boost::math::normal(), -certain);
  return probability < allowed;
}

ChanceTest hotelling(const MeasuredVector& vector) {
  std::vector<Index> scattered;
  for (Index n = 0; n < vector.mean.size(); ++n) {
    if (vector.error(n) > 0) scattered.push_back(n);
  }
  if (scattered.empty()) return {};
  Eigen::VectorXd z(scattered.size());
  for (Index n = 0; n < z.size(); ++n) z[n] = 1 / vector.error(scattered[n]);
  const Eigen::MatrixXd correlation =
      z.asDiagonal() * vector.covariance(scattered, scattered) * z.asDiagonal();
  z.array() *= vector.mean(scattered).array();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(correlation);
  ChanceTest test;
  for (Index n = 0; n < z.size(); ++n) {
    if (axes.eigenvalues()[n] < 1e-9) continue;
    ++test.freedom;
    test.statistic += std::pow(axes.eigenvectors().col(n).dot(z), 2) / axes.eigenvalues()[n];
  }
  const double p = test.freedom, rows = vector.rows;
  if (rows <= p + 1) return {};
  const boost::math::fisher_f law(p, rows - p);
  test.probability =
      cdf(complement(law, std::max(test.statistic, 0.0) * (rows - p) / (p * (rows - 1))));
  return test;
}

ChanceTest two_way_test(const Eigen::MatrixXd& counts) {
  ChanceTest test;
  for (Index a = 0; a < counts.rows(); ++a) {
    for (Index b = a + 1; b < counts.cols(); ++b) {
      const double both = counts(a, b) + counts(b, a);
      if (both < 10) continue;
      ++test.freedom;
      test.statistic += std::pow(counts(a, b) - counts(b, a), 2) / both;
    }
  }
  if (test.freedom == 0) return {};
  const boost::math::chi_squared law(test.freedom);
  test.probability = cdf(complement(law, test.statistic));
  return test;
}

}  // namespace driftless::judge
