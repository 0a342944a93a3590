#include "sim/variables.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/error.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

bool finite(std::span<const float> values) noexcept {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

bool well_formed(const Variable& v) noexcept {
  return v.cyclic_id >= image::kFirstVariable && v.cyclic_id <= image::kLastVariable && v.size >= 1 &&
         v.size <= v.values.size() && finite(std::span(v.values).first(v.size));
}

}  // namespace

Variables::Variables(std::vector<Variable> variables) : variables_(std::move(variables)) {
  std::ranges::sort(variables_, {}, &Variable::cyclic_id);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const bool twice = i > 0 && variables_[i].cyclic_id == variables_[i - 1].cyclic_id;
    if (twice || !well_formed(variables_[i])) {
      throw std::invalid_argument("variable " + std::to_string(variables_[i].cyclic_id) +
                                  ": expected one id of 10000..19999 each, 1 to 6 values, all finite");
    }
    std::fill(variables_[i].values.begin() + static_cast<std::ptrdiff_t>(variables_[i].size),
              variables_[i].values.end(), 0.0f);
  }
}

const Variable* Variables::find(std::uint32_t id) const noexcept {
  const auto found = std::ranges::lower_bound(variables_, id, {}, &Variable::cyclic_id);
  return found != variables_.end() && found->cyclic_id == id ? &*found : nullptr;
}

std::uint16_t Variables::set(const Command& command) noexcept {
  const auto variable = std::ranges::find(variables_, command.id, &Variable::cyclic_id);
  if (variable == variables_.end()) return error::kSetVariable;
  const auto values = std::span(command.arguments).first(variable->size);
  if (!finite(values)) return error::kArguments;
  std::ranges::copy(values, variable->values.begin());
  return error::kNone;
}

std::uint16_t Variables::resolve(Command& command, std::size_t count) const noexcept {
  for (float& argument : std::span(command.arguments).first(count)) {
    // NaN and infinity are numbers of no variable either.
    const bool whole =
        argument >= image::kFirstVariable && argument <= image::kLastVariable && argument == std::trunc(argument);
    const Variable* variable = whole ? find(static_cast<std::uint32_t>(argument)) : nullptr;
    if (variable == nullptr) return error::kGetVariable;
    argument = variable->values[0];
  }
  return error::kNone;
}

std::array<float, 6> Variables::values(std::uint32_t type) const noexcept {
  const Variable* variable = find(type);
  return variable != nullptr ? variable->values : std::array<float, 6>{};
}

}  // namespace meca::sim
