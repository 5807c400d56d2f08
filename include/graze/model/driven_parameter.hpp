#pragma once

#include "graze/model/model.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace graze {

/// How a parameter changes during the motion.
enum class DriveKind {
    shift, ///< parameter + s with a new state s, whose rate is a new parameter: a ramp, or steps from outside
    wave,  ///< parameter + amplitude * sin(phase), with a new amplitude, phase (a state) and angular frequency
};

/// A model in which one parameter has become an exact function of time through one further state, the last one, which
/// nothing else changes. With the new parameters equal to zero, the motion is that of the original model.
struct DrivenParameter {
    Model model;
    std::string state;     ///< name of the new state: the shift, or the phase in [0, 2 pi)
    std::string rate;      ///< of the new parameter: rate of the shift, or angular frequency of the phase
    std::string amplitude; ///< of the amplitude's parameter for a wave; empty for a shift
    Expression value;      ///< the driven parameter as a function of the new state

    /// Returns an expression of the original model (from any graph) in terms of this model's symbols, with the
    /// parameter replaced by its driven value. @throws InputError for symbols that the original model does not have
    Expression of(const Expression& expression) const;

private:
    friend DrivenParameter drive_parameter(const Model& model, std::string_view parameter, DriveKind kind);
    std::shared_ptr<Model> source_;
    std::string parameter_;
};

/// Drives a parameter. Initial states still use the parameter's own value. Symmetries are left out, since a driven
/// motion has none.
/// @throws InputError for an unknown or dependent parameter, and for one on which a period or the value of a phase
/// section depends
DrivenParameter drive_parameter(const Model& model, std::string_view parameter, DriveKind kind);

} // namespace graze
