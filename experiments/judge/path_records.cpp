#include "experiments/judge/path_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/state.hpp"

namespace driftless::judge {

using nlohmann::json;

json path_record(unsigned replicas, std::uint64_t first,
                 const std::function<std::vector<double>(std::uint64_t)>& row) {
  json record = {{"rows", json::array()}, {"failed", 0}};
  for (unsigned n = 0; n < replicas; ++n) {
    try {
      record["rows"].push_back(row(first + n));
    } catch (const StepFailure& failure) {
      if (record["failed"] == 0) record["failure"] = failure.what();
      record["failed"] = record["failed"].get<unsigned>() + 1;
    }
  }
  return record;
}

void PathRecords::add(const json& record) {
  const auto& rows = record["rows"];
  failed_ += record["failed"].get<std::uint64_t>();
  if (failure_.empty()) failure_ = record.value("failure", "");
  if (rows.empty()) return;
  Eigen::MatrixXd part(rows.size(), rows[0].size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const auto values = rows[n].get<std::vector<double>>();
    part.row(static_cast<Eigen::Index>(n)) =
        Eigen::Map<const Eigen::RowVectorXd>(values.data(), part.cols());
  }
  sound_ += rows.size();
  parts_.push_back(std::move(part));
}

bool PathRecords::too_many_failed() const { return sound_ < 20 || failed_ * 100 > sound_; }

Finding PathRecords::broken(const std::string& subject) const {
  return {subject, Verdict::not_resolved,
          fmt::format("{} of {} runs failed ({}): nothing is said of the others.", failed_,
                      failed_ + sound_, failure_)};
}

PathRecords PathRecords::transformed(
    const std::function<Eigen::RowVectorXd(const Eigen::RowVectorXd&)>& change) const {
  PathRecords changed = *this;
  for (auto& part : changed.parts_) {
    Eigen::MatrixXd rows(part.rows(), change(part.row(0)).size());
    for (Eigen::Index n = 0; n < part.rows(); ++n) rows.row(n) = change(part.row(n));
    part = std::move(rows);
  }
  return changed;
}

Estimate PathRecords::mean(Eigen::Index column) const {
  return estimate(parts_, [column](const Eigen::VectorXd& means) { return means[column]; });
}

std::optional<Estimate> PathRecords::derived(const DerivedQuantity& quantity) const {
  try {
    return estimate(parts_, quantity);
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

}  // namespace driftless::judge
