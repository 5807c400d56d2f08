#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"
#include "model/surface_motion.hpp"

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Makes sliding modes watch the events of both sides, with transitions for them.
class SlideEvents {
public:
    SlideEvents(Model& model, const Places& places, SurfaceMotion& motion)
        : model_(model), places_(places), motion_(motion) {}

    /// The name of the event at which a surface is met from the side where its function is negative.
    std::string rising_name(const Slide& slide) const { return event_name(slide.surface) + "-rising"; }
    /// Notes that a mode meets the surface of a slide at an event. @return false when that is known already
    bool add_meeting(std::size_t mode, std::size_t event) { return met_.emplace(mode, event).second; }
    bool meets(std::size_t mode, std::size_t event) const { return met_.contains({mode, event}); }
    /// Makes the sliding mode of a slide watch events besides those that end it, with transitions for them.
    /// @throws InputError where the modes of both sides do not go on alike
    void watch_others(const Slide& slide);
    /// The same for a mode that slides along two surfaces. Where the modes of both sides do not go on alike, the motion
    /// ends.
    /// @param slide between the modes that slide along one of the surfaces only. @param known events of both surfaces
    void watch_at_corner(const Slide& slide, const std::set<std::size_t>& known);

private:
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }
    const std::string& event_name(std::size_t event) const { return model_.events[event].name; }
    std::vector<std::size_t> watched_by_both(const Slide& slide) const;
    void watch(std::size_t sliding, std::vector<std::size_t> watched);
    std::optional<Transition> shared_transition(const Slide& slide, std::size_t event, std::size_t sliding);
    void add_end(const Slide& slide, std::size_t event, std::size_t sliding, const std::string& what);
    bool leaves_surface(const Slide& slide, std::size_t jump);
    void add_by_side(const Slide& slide, const Alternative& alternative, Transition& made, std::size_t sliding) const;

    Model& model_;
    const Places& places_;
    SurfaceMotion& motion_;
    std::set<std::pair<std::size_t, std::size_t>> met_; ///< mode and event at which a slide's surface is met
};

} // namespace graze
