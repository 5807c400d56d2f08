#pragma once

#include "model/model_completion.hpp"
#include "model/model_expand.hpp"
#include "model/surface_motion.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// The state of one friction in a mode; the order is that of `friction_words`.
enum class FrictionState : std::size_t { backward, stick, forward };

/// A friction, expanded.
struct FrictionLaw {
    std::string name{}, path{};
    Expression symbol{}, velocity{}, limit{};          ///< limit: greatest force at rest
    std::size_t stops_forward = 0, stops_backward = 0; ///< events
    std::size_t stop = 0;                              ///< jump
};

/// One of the modes that replace a mode with frictions.
struct FrictionVariant {
    std::size_t mode = 0;
    std::vector<FrictionState> states{};              ///< of the mode's frictions
    std::map<std::size_t, Expression> force{};        ///< of each friction at rest
    std::map<std::size_t, Expression> acceleration{}; ///< of each friction's velocity, if there are several
};

/// States of frictions, by their indices.
using FrictionStates = std::map<std::size_t, FrictionState>;

/// Makes the modes that replace those with frictions, with their rates.
class FrictionModes {
public:
    FrictionModes(Model& model, const Places& places, const std::vector<RubbingMode>& rubbing);

    const std::vector<FrictionLaw>& laws() const { return laws_; }
    /// Returns what a mode with frictions has of them; null for other modes.
    const RubbingMode* rubbing(std::size_t mode) const;
    const std::vector<FrictionVariant>& variants(std::size_t mode) const { return variants_.at(mode); }
    const FrictionVariant& variant(std::size_t mode, const FrictionStates& states) const;
    FrictionStates states_of(const RubbingMode& rubbing, const FrictionVariant& variant) const;
    /// Returns whether a jump leaves the velocity of a friction as it is.
    bool keeps(std::size_t jump, std::size_t law);
    /// Returns whether a variant's motion keeps the velocity of a friction at rest at zero to the last digit.
    bool stays(const FrictionVariant& variant, std::size_t law) const;

private:
    void add_law(const Friction& friction);
    void require_use(std::size_t law) const;
    void add_variants(const RubbingMode& rubbing);
    std::vector<Expression> rates_of(const RubbingMode& rubbing, FrictionVariant& variant);
    std::vector<Expression> rates_at_rest(const RubbingMode& rubbing, FrictionVariant& variant,
                                          const std::vector<std::size_t>& at_rest, std::vector<Expression> field);
    Expression force_at_rest(const RubbingMode& rubbing, const FrictionLaw& law, const Expression& rate) const;

    Model& model_;
    const Places& places_;
    const std::vector<RubbingMode>& rubbing_;
    Expander expander_;
    SurfaceMotion motion_;
    std::vector<FrictionLaw> laws_;
    std::map<std::size_t, std::vector<FrictionVariant>> variants_; ///< by the mode that they replace
};

} // namespace graze
