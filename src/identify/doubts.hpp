#pragma once

#include "graze/identify/coupling.hpp"
#include "graze/identify/identification.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/identify/restitution.hpp"
#include "graze/record/impacts.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Passes samples on, and keeps those of a velocity.
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

/// Warns where what is left of a channel is no noise. @param what it should be, as "a sine"
void doubt(Identification& found, const std::string& name, const std::string& channel, const ResidualTest& left,
           const char* what);
/// Takes out a value that nothing has, and says so.
void refuse_value(Identification& found, const std::string& value, const std::string& why);
/// What shows that velocities are not those of a body that a fixed stop turns back.
void doubt_impacts(Identification& found, const std::string& name, const std::string& channel,
                   const VelocityWatch& watched, std::span<const RecordedImpact> impacts, const Restitution& one);
void refuse_restitutions(Identification& found);
/// What shows that loads are no equilibria is told. Constants that no magnet has are taken out.
void doubt_loads(Identification& found, const std::vector<StaticLoad>& loads, const CouplingSettings& known,
                 const Coupling& constants);
/// Of coils that nobody has: a channel may be another one, or turned around.
void refuse_signs(Identification& found);

} // namespace graze
