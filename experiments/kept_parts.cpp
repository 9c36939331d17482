#include "experiments/kept_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "experiments/files.hpp"
#include "experiments/interrupt.hpp"
#include "experiments/parallel.hpp"
#include "experiments/progress.hpp"
#include "experiments/provenance.hpp"
#include "experiments/text_file.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Open {
  KeptPart* part;
  fs::path stem;  ///< of its files
  fs::path file() const { return stem.string() + ".json"; }
  fs::path checkpoint() const { return stem.string() + ".checkpoint"; }
};

/// Takes up what is kept; the others, the longest first, so that no core waits for a straggler at
/// the end.
std::vector<Open> open_parts(std::vector<KeptPart>& parts, const fs::path& folder) {
  std::vector<Open> open;
  for (auto& part : parts) {
    const json identity = {program_fingerprint(), part.identity};
    const Open one{&part, folder / fingerprint(identity.dump())};
    part.record = kept_record(one.file());
    if (part.record.is_null()) open.push_back(one);
  }
  std::stable_sort(open.begin(), open.end(),
                   [](const Open& a, const Open& b) { return a.part->cost > b.part->cost; });
  return open;
}

}  // namespace

json kept_record(const fs::path& file) {
  if (!fs::exists(file)) return nullptr;
  json record = json::parse(read_text_file(file.string()), nullptr, false);
  return record.is_discarded() ? json() : record;
}

void run_kept_parts(std::vector<KeptPart>& parts, const KeptRun& run) {
  make_output_folder(run.directory, "parts");
  std::atomic<std::size_t> finished = 0;
  const InterruptNotice notice([&] {
    return fmt::format(
        "interrupted; {} of {} parts are finished and kept; the same command goes on: {}",
        finished.load(), parts.size(), run.command);
  });
  auto side_by_side = open_parts(parts, run.directory / "parts");
  finished = parts.size() - side_by_side.size();
  double cost = 0;
  for (const auto& one : side_by_side) cost += one.part->cost;
  Progress progress("parts", parts.size(), cost, run.quiet);
  progress.cells_resumed(finished);
  const auto run_one = [&](const Open& one, unsigned threads, bool tells_steps) {
    progress.replica_started();
    one.part->record = one.part->run({threads, one.checkpoint(), tells_steps});
    progress.replica_finished(one.part->cost);
    const bool failed = one.part->record.is_null();
    if (!failed) {
      const std::string text = one.part->record.dump();
      write_atomically(one.file(), text);
      one.part->record = json::parse(text);  // what a later run would take up
      std::error_code none_is_no_fault;
      fs::remove(one.checkpoint(), none_is_no_fault);
      ++finished;
    }
    progress.cell_finished(one.part->name, failed ? "failed" : "ok");
  };
  const auto first_alone = std::stable_partition(side_by_side.begin(), side_by_side.end(),
                                                 [](const Open& one) { return !one.part->alone; });
  const std::vector<Open> alone(first_alone, side_by_side.end());
  side_by_side.erase(first_alone, side_by_side.end());
  parallel(side_by_side.size(), run.threads,
           [&](std::size_t n) { run_one(side_by_side[n], 1, false); });
  for (const auto& one : alone) run_one(one, run.threads, !run.quiet);
}

}  // namespace driftless
