#include "experiments/fields.hpp"

#include <cmath>
#include <limits>

#include "experiments/checkpoint.hpp"
#include "experiments/statistics.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr std::size_t most_blocks = 32;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// JSON has no numbers that are not finite.
json finite_or_null(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? json(value) : json());
  return list;
}

json by_name(const std::vector<Fields::Quantity>& quantities) {
  json fields = json::object();
  for (const auto& field : quantities) {
    fields[field.name] = {{"values", finite_or_null(field.values)},
                          {"errors", finite_or_null(field.errors)}};
  }
  return fields;
}

void add(const std::vector<double>& from, std::vector<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
}

}  // namespace

Fields::Fields(const System& system, const Bins& bins)
    : lengths_(system.box().lengths),
      bins_(bins),
      groups_(system.fluid().parameters().further_species.empty()
                  ? 1
                  : 2 + system.fluid().parameters().further_species.size()),
      isothermal_(system.fluid().isothermal()),
      boltzmann_(system.fluid().boltzmann()) {
  for (const auto count : bins) {
    if (count < 1 || count > most_bins) throw std::invalid_argument("too few or too many bins");
  }
  if (this->bins() > most_bins) throw std::invalid_argument("too many bins");
  sums_.resize(groups_ * this->bins() * channels);
}

std::size_t Fields::bin_of(const Vector& position) const {
  std::size_t bin = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const auto count = bins_[static_cast<std::size_t>(axis)];
    const double share = position[axis] / lengths_[axis];
    const auto here = static_cast<std::size_t>(share * static_cast<double>(count));
    bin = bin * count + std::min(here, count - 1);  // rounding may reach the upper edge
  }
  return bin;
}

void Fields::sample(System& system, std::uint64_t) {
  sums_.assign(sums_.size(), 0);
  sum_particles(system);
  sum_peculiar(system);
  add_to_block();
  ++samples_;
}

template <class Visit>
void Fields::visit_cells(const System& system, Visit&& visit) const {
  const auto& species = system.state().species;
  for (std::size_t i = 0; i < bin_.size(); ++i) {
    visit(i, std::size_t{bin_[i]});
    const std::size_t own = species.empty() ? 0 : species[i];
    if (groups_ > 1) visit(i, (1 + own) * bins() + bin_[i]);
  }
}

void Fields::sum_particles(const System& system) {
  const State& state = system.state();
  bin_.clear();
  for (const auto& position : state.position) {
    bin_.push_back(static_cast<std::uint32_t>(bin_of(position)));
  }
  visit_cells(system, [&](std::size_t i, std::size_t cell) {
    summed(cell, particles) += 1;
    const double m = system.mass(i);
    summed(cell, mass) += m;
    summed(cell, momentum_x) += m * state.velocity[i][0];
    summed(cell, momentum_y) += m * state.velocity[i][1];
    summed(cell, momentum_z) += m * state.velocity[i][2];
    if (isothermal_) return;
    const double u = state.internal_energy[i];
    summed(cell, inverse_temperature) += 1 / system.equation_of_state(i).temperature(u);
    summed(cell, internal_energy) += u;
  });
}

void Fields::sum_peculiar(const System& system) {
  visit_cells(system, [&](std::size_t i, std::size_t cell) {
    const Vector momentum(summed(cell, momentum_x), summed(cell, momentum_y),
                          summed(cell, momentum_z));
    const Vector mean = momentum / summed(cell, mass);
    summed(cell, peculiar) += system.mass(i) * (system.state().velocity[i] - mean).squaredNorm();
  });
  for (std::size_t cell = 0; cell < groups_ * bins(); ++cell) {
    summed(cell, freedom) = std::max(0.0, summed(cell, particles) - 1);
  }
}

/// Blocks that are full and too many are joined by twos.
void Fields::add_to_block() {
  if (blocks_.empty() || filled_ == block_length_) {
    if (blocks_.size() == most_blocks) {
      for (std::size_t i = 0; i < most_blocks / 2; ++i) {
        add(blocks_[2 * i + 1], blocks_[2 * i]);
        if (i > 0) blocks_[i] = std::move(blocks_[2 * i]);
      }
      blocks_.resize(most_blocks / 2);
      block_length_ *= 2;
    }
    blocks_.emplace_back(sums_.size(), 0.0);
    filled_ = 0;
  }
  add(sums_, blocks_.back());
  ++filled_;
}

double Fields::total(std::size_t cell, Channel channel) const {
  if (channel == channels) return static_cast<double>(samples_);
  double sum = 0;
  for (const auto& block : blocks_) sum += block[cell * channels + channel];
  return sum;
}

std::vector<Fields::Ratio> Fields::ratios() const {
  const double bin_volume = lengths_.prod() / static_cast<double>(bins());
  std::vector<Ratio> all = {{"number_density", particles, channels, 1 / bin_volume},
                            {"velocity_x", momentum_x, mass, 1},
                            {"velocity_y", momentum_y, mass, 1},
                            {"velocity_z", momentum_z, mass, 1}};
  if (boltzmann_ > 0) {
    all.push_back({"kinetic_temperature", peculiar, freedom, 1 / (3 * boltzmann_)});
  }
  if (!isothermal_) {
    all.push_back({"internal_temperature", particles, inverse_temperature, 1});
    all.push_back({"internal_energy", internal_energy, particles, 1});
  }
  return all;
}

double Fields::error(const Ratio& ratio, std::size_t cell) const {
  const std::size_t whole = blocks_.size() - (filled_ < block_length_ ? 1 : 0);
  if (whole < 2) return infinity;
  const auto length = static_cast<double>(block_length_);
  Eigen::MatrixXd means(whole, 2);
  for (std::size_t block = 0; block < whole; ++block) {
    const double* sums = blocks_[block].data() + cell * channels;
    means.row(static_cast<Eigen::Index>(block)) << sums[ratio.numerator] / length,
        ratio.denominator == channels ? 1.0 : sums[ratio.denominator] / length;
  }
  if (!(means.col(1).sum() > 0)) return infinity;
  return estimate({means}, [&](const Eigen::VectorXd& m) { return ratio.factor * m[0] / m[1]; })
      .error;
}

Fields::Quantity Fields::quantity(const Ratio& ratio, std::size_t group) const {
  Quantity result{ratio.name, {}, {}};
  for (std::size_t cell = group * bins(); cell < (group + 1) * bins(); ++cell) {
    const double below = total(cell, ratio.denominator);
    const bool known = below > 0;
    result.values.push_back(known ? ratio.factor * total(cell, ratio.numerator) / below : nothing);
    result.errors.push_back(known ? error(ratio, cell) : infinity);
  }
  return result;
}

std::vector<Fields::Quantity> Fields::quantities_of(std::size_t group) const {
  std::vector<Quantity> all;
  for (const auto& ratio : ratios()) all.push_back(quantity(ratio, group));
  return all;
}

json Fields::to_json() const {
  json axes = json::array();
  for (int axis = 0; axis < 3; ++axis) {
    axes.push_back({{"axis", std::string(1, static_cast<char>('x' + axis))},
                    {"from", 0},
                    {"to", lengths_[axis]},
                    {"bins", bins_[static_cast<std::size_t>(axis)]}});
  }
  json record = {{"axes", axes},
                 {"bins", bins_},
                 {"samples", samples_},
                 {"quantities", by_name(quantities())}};
  for (std::size_t n = 0; n < species(); ++n) record["species"].push_back(by_name(quantities(n)));
  return record;
}

json Fields::settings() const {
  json settings = {{"bins", bins_}};
  if (species() > 0) settings["species"] = species();
  return settings;
}

json Fields::save() {
  json blocks = json::array();
  for (const auto& block : blocks_) blocks.push_back(to_bytes(block));
  return {{"samples", samples_},
          {"block_length", block_length_},
          {"filled", filled_},
          {"blocks", blocks}};
}

void Fields::load(const json& saved) {
  samples_ = saved.at("samples").get<std::uint64_t>();
  block_length_ = saved.at("block_length").get<std::uint64_t>();
  filled_ = saved.at("filled").get<std::uint64_t>();
  blocks_.clear();
  for (const auto& block : saved.at("blocks")) blocks_.push_back(from_bytes<double>(block));
}

}  // namespace driftless
