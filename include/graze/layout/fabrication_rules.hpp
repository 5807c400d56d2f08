#pragma once

#include "graze/layout/layout.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/process_conditions.hpp"

#include <string>
#include <vector>

namespace graze {

/// What a device that was drawn has by a rule: the worst of it, or whatever breaks the rule.
struct RuleFinding {
    std::string rule; ///< as in [rules], or free_way
    double value = 0, limit = 0;
    std::string unit;
    bool at_least = true; ///< whether the limit is the least value, or the greatest
    std::string part;     ///< of the device
    GridPoint at;         ///< of the die
    std::string device;   ///< cell
    bool beyond = false;  ///< whether the limit itself breaks the rule
    std::string key;      ///< in the design file, to blame, as "device.gap"
    std::string remedy;   ///< empty: as for all rules
    std::size_t more = 0; ///< further places that break it and are not listed; of the last one of a rule

    bool holds() const { return beyond ? value > limit : at_least ? value >= limit : value <= limit; }
    /// In one sentence.
    std::string text() const;
};

/// Checks one device by its polygons and the rules that its file does not switch off: distances are those between edges
/// that face each other, on the masks as drawn, and those of etched lines and gaps at the worst depth. Stops and
/// stresses are of the device after the etch.
///
/// The rule free_way needs no limit: the mass meets stops and electrode before anything else, or else the model, which
/// knows nothing else, is wrong. It is found by moving the polygons of mass and trusses along x, after the etch.
/// @return the worst place of each rule, in the order of rule_fields, and after it further places that break it, 5
/// in all, the others are counted; at last free_way to either side
std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout, const DrawnDevice& device);
/// Of all devices of a layout that differ.
std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout);

/// @throws InputErrors (InputError for one) with all that do not hold, at the place of the rule in the design file
void require_rules(const DeviceFile& file, const std::vector<RuleFinding>& findings);

} // namespace graze
