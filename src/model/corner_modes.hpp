#pragma once

#include "model/slide_corners.hpp"
#include "model/slide_events.hpp"

#include <array>
#include <string>
#include <vector>

namespace graze {

/// Makes the modes that slide along two surfaces, and the ways into them and past them.
///
/// At a corner the pushes of the two surfaces are a relay each. Their equations have one solution where the matrix of
/// the rates of both functions with respect to both relays is a P-matrix (J.-S. Pang and D. Stewart 2008): the motion
/// then follows the only solution, which slides along both surfaces, along one, or along none. Where it is no P-matrix,
/// since one of the surfaces does not attract beside the other, motions that come along the attracting one have one
/// solution among those beyond the other; otherwise they end.
class CornerModes {
public:
    CornerModes(Model& model, const Places& places, SurfaceMotion& motion, SlideEvents& events)
        : model_(model), places_(places), motion_(motion), events_(events) {}

    /// Adds what happens where motions along one surface meet the other. To be called before the sliding modes watch
    /// each other's surfaces.
    void add_ways(const SlideCorner& corner);
    /// Makes the mode that slides along both.
    void complete(const SlideCorner& corner);

private:
    /// A slide at a corner.
    struct Arm {
        std::size_t slide = 0, mode = 0, other = 0; ///< index of the slide; its mode; the event of the other surface
        bool above = false;                         ///< the other surface's function is positive
        Expression from_left{}, from_right{};       ///< pushes of both sides towards its own surface
        Expression towards{};                       ///< its push towards the other surface
    };
    /// The four slides: along the first surface below and above the second, along the second below and above the first.
    using Arms = std::array<Arm, 4>;

    const Slide& slide_of(const Arm& arm) const { return model_.slides[arm.slide]; }
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }
    void enter(const SlideCorner& corner);
    Arms arms_of(const SlideCorner& corner);
    std::size_t jump_onto(const SlideCorner& corner);
    std::size_t add_exit(const SlideCorner& corner, const Arm& arm, std::size_t jump);
    void add_ways_from(const SlideCorner& corner, const Arms& arms, std::size_t from, std::size_t jump);

    Model& model_;
    const Places& places_;
    SurfaceMotion& motion_;
    SlideEvents& events_;
};

} // namespace graze
