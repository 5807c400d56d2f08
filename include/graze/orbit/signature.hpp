#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What ends a segment of an orbit.
enum class SegmentEnd {
    event,   ///< the segment's transition is made: its event, its jump
    section, ///< a section of the model is passed, which changes nothing
    cut,     ///< nothing: a plane across the motion is passed, through where the next segment was found to begin
};

/// One smooth piece of an orbit: the motion in a mode, up to an event or section.
struct Segment {
    std::size_t mode = 0;
    SegmentEnd end = SegmentEnd::event;
    std::size_t index = 0; ///< in Model::transitions or Model::sections; of cuts 0
    bool operator==(const Segment&) const = default;
};

/// The cyclic list of an orbit's segments.
using Signature = std::vector<Segment>;

/// Whether a transition may lead to a mode: by one of its alternatives.
bool can_lead_to(const Transition& transition, std::size_t mode);
/// How signatures call a cut: "~".
const std::string& cut_name();
/// The name of a segment's end in signatures: the transition's label, the section's name, or "~" for a cut. It is the
/// model's own, and lives as long.
const std::string& end_name(const Model& model, const Segment& segment);

/// Reads signatures such as "J1 J8", "{J1,J8}^2", "impact^4" or "(impact release)^2 impact": labels of transitions and
/// names of sections, repeated by ^; braces, parentheses and commas only group and part. "~" is a cut. Modes follow
/// from the model's graph; where they do not, write "mode:label".
/// @throws InputError for names that the model does not have, and lists that its graph does not allow
Signature parse_signature(const Model& model, std::string_view text, const Place& place = {});
/// Text that parse_signature reads back, as short as repetition makes it: "(J1 J8)^2".
std::string to_string(const Model& model, const Signature& signature);

/// @param symmetry when these are the first half of an orbit's segments, whose images under it are the second
/// @throws InputError when a segment does not exist or cannot follow the one before
void validate_signature(const Model& model, const Signature& signature, const Place& place = {},
                        std::optional<std::size_t> symmetry = std::nullopt);

} // namespace graze
