#pragma once

#include "graze/layout/layout.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/process_conditions.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Result of one fabrication rule at one place of a drawn device: its worst place, or one that breaks the rule.
struct RuleFinding {
    std::string rule; ///< name of the rule as in [rules], or free_way
    double value = 0, limit = 0;
    std::string unit;
    bool at_least = true; ///< true: the limit is a lower one
    std::string part;     ///< part of the device
    GridPoint at;         ///< position on the die
    std::string device;   ///< cell of the device
    bool beyond = false;  ///< true: the limit itself breaks the rule
    std::string key;      ///< key of the design file that is responsible, such as "device.gap"
    std::string remedy;   ///< empty: the common remedy of rules
    std::size_t more = 0; ///< in the last finding of a rule: number of further places that break it and are not listed

    bool holds() const { return beyond ? value > limit : at_least ? value >= limit : value <= limit; }
    /// Describes the finding in one sentence.
    std::string text() const;
};

/// Checks the polygons of one device by the rules that are not switched off: distances between opposing edges on the
/// drawn masks, and those of etched lines and gaps at the worst depth. Stops and stresses refer to the device after the
/// etch.
///
/// The rule free_way has no limit: the mass must meet stops and electrode before anything else, as the model knows no
/// other contacts. It is checked by moving the polygons of mass and trusses along x, after the etch.
/// @return the worst place of each rule, in the order of rule_fields, each followed by further places that break it (5
/// in all; more are only counted); finally free_way in either direction
std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout, const DrawnDevice& device);
/// Checks all distinct devices of a layout.
std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout);

/// @throws InputErrors (InputError for one) for all broken rules, at the place of the rule in the design file
void require_rules(const DeviceFile& file, const std::vector<RuleFinding>& findings);

} // namespace graze
