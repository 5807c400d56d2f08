#pragma once

#include "graze/identify/coupling.hpp"
#include "graze/identify/identification.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/identify/restitution.hpp"
#include "graze/record/impacts.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// Passes samples on, and keeps a copy of those of a velocity channel.
class VelocityWatch : public SampleSource {
public:
    VelocityWatch(SampleSource& source, std::size_t channel) : source_(&source), channel_(channel) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        const bool more = source_->read(samples);
        values.insert(values.end(), samples.values[channel_].begin(), samples.values[channel_].end());
        return more;
    }
    std::vector<double> values;

private:
    SampleSource* source_;
    std::size_t channel_;
};

/// Adds a warning if the residuals of a channel are not random noise. @param what the model of the channel, such as "a
/// sine"
void check_residuals(Identification& found, const std::string& name, const std::string& channel,
                     const ResidualTest& left, const char* what);
/// Removes a value that is physically impossible, with a warning that says why.
void remove_value(Identification& found, const std::string& value, const std::string& why);
/// Adds warnings where the velocities are not those of a body that a fixed stop reflects.
void check_impacts(Identification& found, const std::string& name, const std::string& channel,
                   const VelocityWatch& watched, std::span<const RecordedImpact> impacts, const Restitution& one);
/// Removes coefficients of restitution that no impact can have: above one, or not positive.
void check_restitutions(Identification& found);
/// Adds warnings where the loads are not equilibria, and removes constants that no magnet can have.
void check_loads(Identification& found, const std::vector<StaticLoad>& loads, const CouplingSettings& known,
                 const Coupling& constants);
/// Removes resistances and inductances that are not positive: a channel was mistaken for another one, or has the wrong
/// sign.
void check_coil(Identification& found);

} // namespace graze
