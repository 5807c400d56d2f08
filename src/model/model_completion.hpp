#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Model::complete, with places in the model file.
void complete_model(Model& model, const Places& places);
/// Appends, without rates, the modes that slides, frictions and contacts make, so that other parts may name them.
/// @throws InputError when a name is taken
void name_derived_modes(Model& model, const Places& places);
/// The same for the modes that slide along two surfaces, once slides are complete. @throws InputError
void name_corner_modes(Model& model, const Places& places);
/// Returns the model as it was declared, with the present values. Its derived modes have no rates.
/// @param model completed, with slides or frictions
Model declared_model(const Model& model);
/// Returns whether a completed model is still what its declarations make of it.
bool is_as_declared(const Model& model);
/// Takes the initial mode from `initial_modes`, if there are any.
void choose_initial_mode(Model& model);

/// Returns the modes that contain the name of a friction, and for each the indices of these frictions.
struct RubbingMode {
    std::size_t mode = 0;
    std::vector<std::size_t> frictions{};
};
std::vector<RubbingMode> rubbing_modes(const Model& model);
/// Directions of a friction in a mode: the ends of the names of modes.
inline constexpr std::array<std::string_view, 3> friction_words{"backward", "stick", "forward"};
/// Completes frictions: replaces the modes that contain them.
void complete_frictions(Model& model, const Places& places, const std::vector<RubbingMode>& rubbing);
/// Names of the laws of impact, in the order of ImpactLaw.
inline constexpr std::array<std::string_view, 4> impact_law_words{"newton", "moreau", "poisson", "sequence"};
/// Checks declarations of contacts on which all that is made of them relies. @throws InputError
void check_contacts(const Model& model, const Places& places);
/// Completes contacts: events, jumps, modes of closed contacts.
void complete_contacts(Model& model, const Places& places);
/// Completes slides.
void complete_slides(Model& model, const Places& places);

/// Returns values in the initial state; none if there is no initial state.
std::vector<double> values_at_start(const Model& model, std::span<const Expression> expressions);
/// Returns whether an expression contains a symbol.
bool contains_symbol(const Expression& expression, const Expression& symbol);
/// Adds a derived event of this name, or returns the one that another declaration has made.
/// @param path of the declaration, for the message when the user has an event of this name
std::size_t derived_event(Model& model, const Places& places, const std::string& path, Event event);
/// The same for a jump.
std::size_t derived_jump(Model& model, const Places& places, const std::string& path, Jump jump);
/// Passes every index of a mode to `visit`: of transitions, symmetries, slides, drawn shapes.
void visit_mode_indices(Model& model, const std::function<void(std::size_t&)>& visit);

} // namespace graze
