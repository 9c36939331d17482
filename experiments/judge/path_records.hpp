#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {

/// Numbers of each replica, {"rows": [[...], ...], "failed": how many replicas broke, "failure":
/// how the first of them did}; a replica that breaks is left out.
nlohmann::json path_record(unsigned replicas, std::uint64_t first,
                           const std::function<std::vector<double>(std::uint64_t)>& row);

/// The rows of many parts, independent of each other.
class PathRecords {
 public:
  void add(const nlohmann::json& record);

  /// Those left would be no fair sample of what the method does.
  bool too_many_failed() const;
  /// A finding that says so.
  Finding broken(const std::string& subject) const;

  /// The same replicas with other numbers.
  PathRecords transformed(
      const std::function<Eigen::RowVectorXd(const Eigen::RowVectorXd&)>& change) const;

  Estimate mean(Eigen::Index column) const;
  /// Of a function of the columns' means; nothing where it is not finite.
  std::optional<Estimate> derived(const DerivedQuantity& quantity) const;

 private:
  std::vector<Eigen::MatrixXd> parts_;
  std::uint64_t failed_ = 0, sound_ = 0;
  std::string failure_;
};

}  // namespace driftless::judge
