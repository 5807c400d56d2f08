#pragma once

#include "graze/model/model.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace graze {

/// How a parameter may change while the motion goes on.
enum class DriveKind {
    shift, ///< it is its own value plus a new state, whose rate is a new parameter: a ramp, or steps from outside
    wave,  ///< it is its own value plus amplitude * sin(phase), with a new state that turns at a new frequency
};

/// A model in which one parameter has become a function of time, exactly: of a further state, the last one, which
/// nothing else changes. With the new parameters zero it is the model that it was made from.
struct DrivenParameter {
    Model model;
    std::string state;     ///< name of the new one: the shift, or the phase in [0, 2 pi)
    std::string rate;      ///< of the new parameter: rate of the shift, or angular frequency of the phase
    std::string amplitude; ///< of the further new parameter of a wave; empty: none
    Expression value;      ///< of the driven parameter now

    /// An expression in symbols of the model from which this was made, of any graph, in terms of this one's, with the
    /// parameter as it is now. @throws InputError for symbols that the model does not have
    Expression of(const Expression& expression) const;

private:
    friend DrivenParameter drive_parameter(const Model& model, std::string_view parameter, DriveKind kind);
    std::shared_ptr<Model> source_;
    std::string parameter_;
};

/// Initial states keep to the parameter's own value. Symmetries are left out, since a driven motion has none.
/// @throws InputError for an unknown or dependent parameter, and for one on which a period or the place of a phase
///         section depends
DrivenParameter drive_parameter(const Model& model, std::string_view parameter, DriveKind kind);

} // namespace graze
