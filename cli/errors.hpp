// `meca-ctl errors`: what the robot's error codes and safety stops mean and what to do about them, from the tables of
// transports/image: as a list, one by one, as JSON, and as the page docs/errors.md.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cli/json.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/stop_signals.hpp"

namespace meca::cli {

using Trouble = std::variant<const image::ErrorInfo*, const image::StopInfo*>;

std::vector<Trouble> all_troubles();  // stops first, as on the page

// By number or by name in any case: "1007", "joint_over_limit", "3032", "EStop". Throws UsageError.
Trouble find_trouble(std::string_view word);

std::string explain(const Trouble& trouble);  // for a person, some lines
Json to_json(const Trouble& trouble);
std::string troubles_list();  // one line each
std::string troubles_page();  // docs/errors.md

}  // namespace meca::cli
