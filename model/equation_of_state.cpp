#include "model/equation_of_state.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

namespace driftless {
namespace {

void require(bool allowed, const char* name, double value, const std::string& range) {
  if (allowed && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " is " << value << ", allowed is " << range;
  throw std::invalid_argument(message.str());
}

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// What is wrong with a point, given the one before it; empty if nothing is.
std::string complaint_about(const StatePoint& point, const StatePoint* before) {
  if (!std::isfinite(point.temperature)) return "its temperature is not a finite number";
  if (!std::isfinite(point.internal_energy)) return "its internal energy is not a finite number";
  if (!(point.temperature > 0)) return "its temperature is not above 0";
  if (!(point.internal_energy > 0)) return "its internal energy is not above 0";
  if (!before) return {};
  if (!(point.temperature > before->temperature)) {
    return "its temperature is not above " + text_of(before->temperature) +
           ", that of the point before it";
  }
  if (!(point.internal_energy > before->internal_energy)) {
    return "its internal energy is not above " + text_of(before->internal_energy) +
           ", that of the point before it, so that the heat capacity between them is not above 0";
  }
  const double capacity =
      (point.internal_energy - before->internal_energy) / (point.temperature - before->temperature);
  if (!std::isfinite(capacity) || !(capacity > 0)) {
    return "the heat capacity from the point before it is " + text_of(capacity);
  }
  return {};
}

void check(const std::vector<StatePoint>& points) {
  if (points.size() < 2) {
    throw std::invalid_argument("an equation of state has " + std::to_string(points.size()) +
                                " points, at least 2 are needed");
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto complaint = complaint_about(points[n], n > 0 ? &points[n - 1] : nullptr);
    if (complaint.empty()) continue;
    std::ostringstream message;
    message << "point " << n + 1 << " of the equation of state (temperature "
            << points[n].temperature << ", internal energy " << points[n].internal_energy
            << ") is refused: " << complaint;
    throw std::invalid_argument(message.str());
  }
}

/// The heat capacity at each point: that of the parabola through it and its neighbours, kept below
/// twice the mean ones to its sides, so that it cannot reach 0 half-way; at both ends, that of the
/// parabola which goes on.
std::vector<double> capacities_at(const std::vector<StatePoint>& points) {
  const std::size_t last = points.size() - 1;
  std::vector<double> width(last), mean(last), capacity(last + 1);
  for (std::size_t n = 0; n < last; ++n) {
    width[n] = points[n + 1].temperature - points[n].temperature;
    mean[n] = (points[n + 1].internal_energy - points[n].internal_energy) / width[n];
  }
  constexpr double most = 1.9, least = 0.1;  // either sum below 4 times the mean
  for (std::size_t n = 1; n < last; ++n) {
    const double parabola =
        (width[n] * mean[n - 1] + width[n - 1] * mean[n]) / (width[n - 1] + width[n]);
    capacity[n] = std::min(parabola, most * std::min(mean[n - 1], mean[n]));
  }
  const auto at_end = [&](double mean_beside, double inner) {
    return std::clamp(2 * mean_beside - inner, least * mean_beside, most * mean_beside);
  };
  if (last == 1) return {mean[0], mean[0]};
  capacity[0] = at_end(mean[0], capacity[1]);
  capacity[last] = at_end(mean[last - 1], capacity[last - 1]);
  return capacity;
}

LinearHeatCapacity piece_between(double u, double theta, double capacity, double end_theta,
                                 double end_capacity) {
  return {u, theta, capacity, (end_capacity - capacity) / (end_theta - theta)};
}

}  // namespace

EquationOfState EquationOfState::constant_heat_capacity(double heat_capacity) {
  require(heat_capacity > 0, "heat_capacity", heat_capacity, "> 0");
  EquationOfState state;
  state.heat_capacity_ = heat_capacity;
  state.inverse_heat_capacity_ = 1 / heat_capacity;
  return state;
}

EquationOfState EquationOfState::linear_heat_capacity(double heat_capacity, double slope,
                                                      double temperature) {
  require(heat_capacity > 0, "heat_capacity", heat_capacity, "> 0");
  require(temperature > 0, "temperature", temperature, "> 0");
  const double at_zero = heat_capacity - slope * temperature;
  require(slope >= 0 && at_zero > 0, "heat_capacity_slope", slope,
          "from 0 to below heat_capacity/temperature, which is " +
              text_of(heat_capacity / temperature) +
              ", so that the heat capacity is above 0 at all temperatures");
  if (slope == 0) return constant_heat_capacity(heat_capacity);
  EquationOfState state;
  state.form_ = Form::linear;
  state.linear_ = {0, 0, at_zero, slope};
  return state;
}

EquationOfState EquationOfState::reservoir(double temperature) {
  require(temperature > 0, "temperature", temperature, "> 0");
  EquationOfState state;
  state.form_ = Form::reservoir;
  state.temperature_ = temperature;
  state.inverse_temperature_ = 1 / temperature;
  return state;
}

EquationOfState EquationOfState::table(const std::vector<StatePoint>& points) {
  check(points);
  const auto capacity = capacities_at(points);
  EquationOfState state;
  state.form_ = Form::table;
  auto& pieces = state.pieces_;
  const auto& first = points.front();
  pieces.push_back({0, 0, first.internal_energy / first.temperature, 0});
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const auto &from = points[n], &to = points[n + 1];
    const double half = 0.5 * (to.temperature - from.temperature);
    const double mean = (to.internal_energy - from.internal_energy) / (2 * half);
    // The bend's capacity gives both halves together the energy between the points.
    const double bend = 2 * mean - 0.5 * (capacity[n] + capacity[n + 1]);
    const double theta = from.temperature + half;
    const double u = from.internal_energy + 0.5 * half * (capacity[n] + bend);
    pieces.push_back(
        piece_between(from.internal_energy, from.temperature, capacity[n], theta, bend));
    pieces.push_back(piece_between(u, theta, bend, to.temperature, capacity[n + 1]));
  }
  const auto& last = points.back();
  pieces.push_back({last.internal_energy, last.temperature, capacity.back(), 0});
  state.entropies_ = {0, pieces[0].entropy(first.internal_energy)};
  for (std::size_t n = 1; n + 1 < pieces.size(); ++n) {
    const double u = pieces[n].u;
    state.entropies_.push_back(state.entropies_[n] +
                               pieces[n].entropy_gain(u, pieces[n + 1].u - u));
  }
  return state;
}

std::size_t EquationOfState::place_of(double internal_energy) const {
  const auto above = std::upper_bound(
      pieces_.begin() + 1, pieces_.end(), internal_energy,
      [](double energy, const LinearHeatCapacity& piece) { return energy < piece.u; });
  return static_cast<std::size_t>(above - pieces_.begin()) - 1;
}

double EquationOfState::table_entropy(double internal_energy) const {
  const std::size_t place = place_of(internal_energy);
  const auto& piece = pieces_[place];
  if (place == 0) return piece.entropy(internal_energy);
  return entropies_[place] + piece.entropy_gain(piece.u, internal_energy - piece.u);
}

double EquationOfState::table_entropy_gain(double internal_energy, double gain) const {
  std::size_t place = place_of(internal_energy);
  const std::size_t end = place_of(internal_energy + gain);
  double sum = 0;
  // From border to border, so that small gains are not differences of large entropies.
  while (place != end) {
    const double border = pieces_[place < end ? place + 1 : place].u;
    const double part = border - internal_energy;
    sum += pieces_[place].entropy_gain(internal_energy, part);
    internal_energy = border;
    gain -= part;
    place = place < end ? place + 1 : place - 1;
  }
  return sum + pieces_[place].entropy_gain(internal_energy, gain);
}

double EquationOfState::internal_energy(double temperature) const {
  if (form_ == Form::constant) return heat_capacity_ * temperature;
  if (form_ == Form::reservoir) return temperature_;
  if (form_ == Form::linear) return linear_.internal_energy(temperature);
  const auto above = std::upper_bound(
      pieces_.begin() + 1, pieces_.end(), temperature,
      [](double theta, const LinearHeatCapacity& piece) { return theta < piece.theta; });
  return (above - 1)->internal_energy(temperature);
}

}  // namespace driftless
