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
    event,   ///< a transition: its event happens and its jump is applied
    section, ///< the motion passes a section of the model; state and mode do not change
    cut,     ///< the motion passes a plane laid across it by the program; state and mode do not change
    chatter, ///< infinitely many contacts of a transition accumulate, and its `chatter` is made
    rest,    ///< nothing ends it: the state is an equilibrium of the mode. The only segment of its signature
    saddle,  ///< the motion approaches a saddle, which it left with the first segment: a homoclinic orbit
};

/// One piece of an orbit: the motion in a mode, up to an event or section, or to a saddle; or rest in an equilibrium.
/// It is smooth, unless it is a complete chatter sequence: then it has infinitely many contacts.
struct Segment {
    std::size_t mode = 0;
    SegmentEnd end = SegmentEnd::event;
    /// In Model::transitions (event, chatter) or Model::sections; 0 for cuts and equilibria.
    std::size_t index = 0;
    bool operator==(const Segment&) const = default;
};

/// The cyclic list of an orbit's segments.
using Signature = std::vector<Segment>;

/// True when one of a transition's alternatives leads to the mode.
bool can_lead_to(const Transition& transition, std::size_t mode);
/// The name of a cut in signatures: "~".
const std::string& cut_name();
/// The signature of an equilibrium: "equilibrium".
const std::string& rest_name();
/// Returns the signature of an equilibrium in a mode.
Signature signature_of_rest(std::size_t mode);
/// True for the signature of an equilibrium.
bool is_rest(const Signature& signature);
/// The name of the end of a homoclinic orbit in signatures: "saddle".
const std::string& saddle_name();
/// True for the signature of a homoclinic orbit: its last segment approaches a saddle.
bool is_homoclinic(const Signature& signature);
/// What follows the label of a transition whose contacts accumulate, in signatures: "*", as in "impact* release".
const std::string& chatter_mark();
/// True when a transition ends a segment, or its contacts accumulate there, rather than that it passes a section or
/// cut.
inline bool ends_by_transition(const Segment& segment) {
    return segment.end == SegmentEnd::event || segment.end == SegmentEnd::chatter;
}
/// Returns the transition that ends a segment, or whose contacts accumulate there; null for sections and cuts.
const Transition* transition_of(const Model& model, const Segment& segment);
/// Returns the name of a segment's end in signatures: the label of the transition (with "*" where its contacts
/// accumulate), the name of the section, "~" for a cut, "saddle"
/// for the approach to one, or "equilibrium" for rest.
std::string end_name(const Model& model, const Segment& segment);

/// Reads signatures such as "J1 J8", "{J1,J8}^2", "impact^4" or "(impact release)^2 impact": labels of transitions and
/// names of sections, repeated by ^; braces and parentheses group, commas separate. "~" is a cut, "equilibrium" a state
/// at rest, "impact*" a complete chatter sequence: all contacts of this transition, up to their accumulation. "impact
/// saddle" is a homoclinic orbit with one contact. Modes are deduced from the model's graph; where they are ambiguous,
/// write "mode:label".
/// @throws InputError for names that the model does not have and sequences that its graph does not allow
Signature parse_signature(const Model& model, std::string_view text, const Place& place = {});
/// Returns text that parse_signature reads back, with repetitions abbreviated: "(J1 J8)^2".
std::string to_string(const Model& model, const Signature& signature);

/// @param symmetry of the model, when the signature is the first half of an orbit and the second half is its image
/// @throws InputError when a segment does not exist in the model or cannot follow the one before
void validate_signature(const Model& model, const Signature& signature, const Place& place = {},
                        std::optional<std::size_t> symmetry = std::nullopt);

} // namespace graze
