#include "graze/identify/identification.hpp"

#include "graze/base/input_error.hpp"
#include "graze/identify/coupling.hpp"
#include "graze/identify/decrement.hpp"
#include "graze/identify/impedance.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/identify/restitution.hpp"
#include "identify/common_units.hpp"
#include "identify/estimate_checks.hpp"
#include "identify/impact_proportion.hpp"
#include "identify/row_gap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace graze {

namespace {

constexpr std::size_t most_samples = 10'000'000;

/// Fills in the diagonal of the covariance matrix.
void set_variances(Identification& found) {
    const std::size_t count = found.values.size();
    found.covariance.assign(count * count, 0);
    for (std::size_t i = 0; i < count; ++i)
        found.covariance[i * count + i] = found.values[i].estimate.error * found.values[i].estimate.error;
}

double mean_of_estimates(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A record in common units; refuses records without rows and numbers whose squares and ratios would overflow or
/// underflow.
class UsableSource : public CommonUnitSource {
public:
    UsableSource(SampleSource& source, CommonUnits& units, const std::vector<std::size_t>& channels,
                 Times times = Times::common)
        : CommonUnitSource(source, units, channels, times), channels_(channels), greatest_(channels.size()) {}
    bool read(Samples& samples) override {
        const bool more = CommonUnitSource::read(samples);
        if (samples.rows() > 0 && !has_rows_)
            first_ = samples.times.front();
        has_rows_ = has_rows_ || samples.rows() > 0;
        if (!has_rows_)
            throw InputError("the record has no rows", "give one with rows, and look at what part of it is wanted");
        for (std::size_t c = 0; c < channels_.size(); ++c)
            for (const double value : samples.values[channels_[c]])
                greatest_[c] = std::max(greatest_[c], std::abs(value));
        if (samples.rows() > 0)
            last_ = samples.times.back();
        constexpr double largest = 1e100, smallest = 1e-100;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            if (greatest_[c] > largest || (!more && greatest_[c] > 0 && greatest_[c] < smallest))
                refuse(header().channels[channels_[c]].name, greatest_[c]);
        const double time = std::max(std::abs(first_), std::abs(last_));
        if (time > largest || (!more && time > 0 && time < smallest))
            refuse(header().time.name, time);
        return more;
    }

private:
    [[noreturn]] static void refuse(const std::string& name, double value) {
        throw InputError(
            fmt::format("the values of '{}' go up to {:.3g}: numbers of that size are not handled", name, value),
            fmt::format("use another unit (scale {}={:.0e})", name, std::min(1 / value, 1e300)));
    }

    std::vector<std::size_t> channels_;
    std::vector<double> greatest_; ///< largest magnitudes so far
    double first_ = 0, last_ = 0;
    bool has_rows_ = false;
};

/// Refuses releases of which none has three peaks: they do not determine a standard error.
void require_three_peaks(const std::vector<DecayPeaks>& releases, const std::vector<std::string>& names) {
    constexpr std::size_t fewest = 3;
    if (names.empty() ||
        std::any_of(releases.begin(), releases.end(), [](const DecayPeaks& one) { return one.times.size() >= fewest; }))
        return;
    for (std::size_t r = 0; r < releases.size(); ++r)
        if (const ResidualTest& left = releases[r].wave.residual_test; !left.is_noise())
            throw InputError(fmt::format("{}: this is not a damped sine: {}", names[r], left.text()),
                             "look at the record there, and give a part of it that is free of that");
    throw InputError(
        fmt::format("{}{}: there are too few peaks to determine standard errors: two stand out from the noise, "
                    "three are needed",
                    names.front(), names.size() > 1 ? " and others" : ""),
        "give a longer record or one with less damping, and take three peaks or more");
}

/// Refuses a channel that is not a velocity: a displacement has corners, which resemble jumps.
void require_impacts(const std::string& name, const std::string& channel, const std::vector<RecordedImpact>& impacts) {
    if (const std::size_t doubtful = doubtful_impacts(impacts); 2 * doubtful >= impacts.size())
        throw InputError(fmt::format("{}: at {} of {} jumps of '{}' the velocity before is not larger than twice its "
                                     "error, or has the sign of that after: these are not impacts",
                                     name, doubtful, impacts.size(), channel),
                         "look at which channel is the velocity, and give velocities relative to the "
                         "stop");
}

/// The measured current in the first periods of a record, with its fitted sine.
Identification::Shown shown_current(const Samples& all, std::size_t current, const Impedance& one) {
    constexpr double periods = 3;
    const double middle = 0.5 * (all.times.front() + all.times.back());
    Identification::Shown shown;
    for (std::size_t i = 0; i < all.rows(); ++i) {
        const double t = all.times[i];
        if (t > all.times.front() + periods * 2 * std::numbers::pi / one.frequency)
            break;
        const double value = one.current.at(t - middle);
        shown.measured.add(t, all.values[current][i]);
        shown.fitted.add(t, value);
        shown.left.add(t, all.values[current][i] - value);
    }
    return shown;
}

} // namespace

Identification identify_decrement(const EachRecord& records, const IdentificationSettings& settings) {
    std::vector<DecayPeaks> releases;
    RecordHeader header;
    std::size_t channel = 0;
    std::vector<std::string> names;
    CommonUnits units;
    records([&](const std::string& name, SampleSource& record) {
        channel = record.header().channel(settings.channel, "channel");
        UsableSource usable(record, units, {channel});
        header = usable.header();
        releases.push_back(decay_peaks(usable, channel, settings.peaks));
        names.push_back(name);
    });
    require_three_peaks(releases, names);
    const Decrement decrement = logarithmic_decrement(releases);
    std::vector<DecayWave> waves;
    for (const DecayPeaks& peaks : releases)
        waves.push_back(peaks.wave);
    const DampedOscillation oscillation = damped_oscillation(waves);
    const Channel &time = header.time, &velocity = header.channels[channel];
    const std::string per_time = time.unit.empty() ? "" : "rad/" + time.unit;
    Identification found;
    found.values = {{"natural_frequency", per_time, oscillation.frequency},
                    {"damping_ratio", "", oscillation.damping},
                    {"natural_frequency_of_pairs", per_time, {decrement.pair_frequency, 0, 0}},
                    {"damping_ratio_of_pairs", "", {decrement.pair_damping, 0, 0}}};
    std::vector<Estimate> rests;
    for (const DecayPeaks& peaks : releases)
        rests.push_back({peaks.rest, peaks.rest_error, decrement.damping.freedom});
    found.values.push_back({"rest_position", velocity.unit, combine(rests).mean});
    for (std::size_t r = 0; r < releases.size(); ++r)
        check_residuals(found, names[r], velocity.name, releases[r].wave.residual_test, "a damped sine");
    constexpr double level = 1e-4;
    if (oscillation.chance < level)
        found.warnings.emplace_back(
            "the releases differ by more than their noise: frequency or damping changes from one "
            "to the next, and intervals are too narrow");
    if (!(oscillation.damping.value > 0))
        remove_value(found, "damping_ratio", "the oscillation grows");
    set_variances(found);
    found.x = {time.name + " since the first peak", time.unit};
    found.y = {"peaks of " + velocity.name, velocity.unit};
    for (std::size_t r = 0; r < releases.size(); ++r) {
        const double first = decrement.fitted[r].times.front();
        Identification::Shown& shown = found.shown.emplace_back();
        for (std::size_t k = 0; k < releases[r].times.size(); ++k) {
            const double t = releases[r].times[k] - first, height = decrement.fitted[r].heights[k];
            shown.measured.add(t, releases[r].heights[k]);
            shown.fitted.add(decrement.fitted[r].times[k] - first, height);
            shown.left.add(t, releases[r].heights[k] - height);
        }
    }
    return found;
}

Identification identify_restitution(const EachRecord& records, const IdentificationSettings& settings) {
    Identification found;
    std::vector<Estimate> sets;
    std::vector<std::string> names;
    Channel velocity;
    std::vector<ImpactSpeeds> few;
    CommonUnits units;
    records([&](const std::string& name, SampleSource& record) {
        const ImpactSettings of_impacts =
            impact_settings(record.header(), settings.channel, settings.displacement, settings.impacts);
        std::vector<ImpactSpeeds> impacts;
        std::vector used{of_impacts.velocity};
        if (of_impacts.displacement)
            used.push_back(*of_impacts.displacement);
        UsableSource usable(record, units, used, UsableSource::Times::as_they_are);
        velocity = usable.header().channels[of_impacts.velocity];
        VelocityWatch watched(usable, of_impacts.velocity);
        const std::vector<RecordedImpact> recorded = find_impacts(watched, of_impacts);
        for (const RecordedImpact& impact : recorded)
            impacts.push_back({impact.before, impact.after, impact.before_error, impact.after_error});
        if (impacts.size() < 3) { // a sweep may start without impacts
            few = impacts;
            return;
        }
        require_impacts(name, velocity.name, recorded);
        const Restitution one = restitution(impacts);
        check_impacts(found, name, velocity.name, watched, recorded, one);
        sets.push_back(one.coefficient);
        names.push_back(name);
        Identification::Shown& shown = found.shown.emplace_back();
        for (std::size_t i = 0; i < impacts.size(); ++i) {
            shown.measured.add(impacts[i].before, impacts[i].after);
            shown.left.add(impacts[i].before, one.residuals[i]);
        }
    });
    if (sets.empty()) { // no record has three impacts: use one with two
        sets.push_back(restitution(few).coefficient);
        names.emplace_back();
        Identification::Shown& shown = found.shown.emplace_back();
        for (const ImpactSpeeds& one : few) {
            shown.measured.add(one.before, one.after);
            shown.left.add(one.before, one.after + sets.front().value * one.before);
        }
    }
    const Combined all = combine(sets);
    found.values.push_back({"restitution", "", all.mean});
    for (std::size_t i = 0; i < sets.size() && sets.size() > 1; ++i)
        found.values.push_back({"restitution of " + names[i], "", sets[i]});
    if (sets.size() > 1)
        found.values.push_back({"spread_between_records", "", {all.spread, 0, 0}});
    check_restitutions(found);
    set_variances(found);
    double fastest = 0, slowest = 0;
    for (const Identification::Shown& shown : found.shown)
        for (const double speed : shown.measured.x) {
            fastest = std::max(fastest, speed);
            slowest = std::min(slowest, speed);
        }
    const double e = all.mean.value;
    found.shown.front().fitted = {{slowest, fastest}, {-e * slowest, -e * fastest}};
    found.x = {velocity.name + " before", velocity.unit};
    found.y = {velocity.name + " after impacts", velocity.unit};
    return found;
}

Identification identify_coupling(const EachRecord& records, const IdentificationSettings& settings) {
    if (!settings.gap || !settings.stiffness)
        throw InputError("gap or stiffness are not known", "give gap and stiffness, in the units of the record");
    const std::string place = settings.displacement.empty() ? "q" : settings.displacement;
    std::vector<StaticLoad> loads;
    Channel displacement, current;
    CommonUnits units;
    records([&](const std::string&, SampleSource& record) {
        const RecordHeader& header = record.header();
        const std::size_t q = header.channel(place, "displacement"), i = header.channel(settings.current, "current");
        UsableSource usable(record, units, {q, i}, UsableSource::Times::as_they_are);
        displacement = usable.header().channels[q];
        current = usable.header().channels[i];
        const Samples all = read_all(usable, most_samples);
        if (settings.one_load_a_record)
            loads.push_back({mean_of_estimates(all.values[q]), mean_of_estimates(all.values[i])});
        for (std::size_t row = 0; row < all.rows() && !settings.one_load_a_record; ++row)
            loads.push_back({all.values[q][row], all.values[i][row]});
    });
    const CouplingSettings known{*settings.gap,
                                 settings.gap_error,
                                 *settings.stiffness,
                                 settings.stiffness_error,
                                 settings.displacement_noise,
                                 settings.current_noise};
    const Coupling constants = coupling(loads, known);
    const std::string &length = displacement.unit, &ampere = current.unit;
    // The stiffness is in N/m if lengths are in m.
    const std::string product = length != "m" || ampere.empty() ? ""
                                : ampere == "A"                 ? "H m"
                                                                : fmt::format("N m^2/{0} {0}", ampere);
    Identification found;
    found.values = {{"beta1", product, constants.beta1},
                    {"beta2", length, constants.beta2},
                    {"correlation", "", {constants.correlation, 0, 0}},
                    {"beta1_of_regression", product, {constants.regression_beta1, 0, 0}},
                    {"beta2_of_regression", length, {constants.regression_beta2, 0, 0}}};
    check_loads(found, loads, known, constants);
    set_variances(found);
    const std::size_t count = found.values.size();
    if (count > 1 && found.values[0].name == "beta1" && found.values[1].name == "beta2")
        found.covariance[1] = found.covariance[count] =
            constants.correlation * constants.beta1.error * constants.beta2.error;
    found.x = current;
    found.y = displacement;
    Identification::Shown& shown = found.shown.emplace_back();
    double furthest = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        shown.measured.add(loads[i].current, loads[i].displacement);
        shown.left.add(loads[i].current, constants.residuals[i]);
        furthest = std::max(furthest, loads[i].displacement);
    }
    constexpr int points = 200;
    for (int i = 0; i <= points && constants.beta1.value > 0; ++i) {
        const double q = furthest * i / points;
        shown.fitted.add(
            (known.gap + constants.beta2.value - q) * std::sqrt(2 * known.stiffness * q / constants.beta1.value), q);
    }
    return found;
}

Identification identify_impedance(const EachRecord& records, const IdentificationSettings& settings) {
    if (settings.beta1.has_value() != settings.beta2.has_value() || (settings.beta1 && !settings.gap))
        throw InputError("a leakage inductance needs beta1, beta2 and the gap", "give beta1, beta2 and gap, or none");
    std::vector<Estimate> frequencies, resistances, inductances, leakages;
    std::vector<std::string> names;
    Identification found;
    std::string ohm, henry, hertz;
    CommonUnits units;
    records([&](const std::string& name, SampleSource& record) {
        const std::size_t v = record.header().channel(settings.voltage, "voltage"),
                          c = record.header().channel(settings.current, "current");
        UsableSource usable(record, units, {v, c});
        const RecordHeader& header = usable.header();
        const Samples all = read_all(usable, most_samples);
        const Impedance one = impedance(all.times, all.values[v], all.values[c],
                                        settings.frequency ? 2 * std::numbers::pi * *settings.frequency : 0);
        names.push_back(name);
        frequencies.push_back({one.frequency / (2 * std::numbers::pi), 0, 0});
        resistances.push_back(one.resistance);
        inductances.push_back(one.inductance);
        check_residuals(found, name, header.channels[v].name, one.voltage_test, "a sine");
        check_residuals(found, name, header.channels[c].name, one.current_test, "a sine");
        if (const auto gap = longest_gap(all.times); gap && !settings.frequency && !one.voltage_test.is_noise())
            found.warnings.push_back(fmt::format("{}: there are no rows from {:.6g} to {:.6g}, so the frequency may "
                                                 "be wrong: give an approximate one by frequency",
                                                 name, gap->from, gap->to));
        if (settings.beta1)
            leakages.push_back(
                leakage_inductance(one.inductance, *settings.beta1, *settings.beta2, *settings.gap, settings.clamped));
        const std::string& time = header.time.unit;
        hertz = time == "s" ? "Hz" : time.empty() ? "" : "1/" + time;
        const std::string &volt = header.channels[v].unit, &ampere = header.channels[c].unit;
        if (!volt.empty() && !ampere.empty()) {
            const bool plain = volt == "V" && ampere == "A";
            ohm = plain ? "ohm" : fmt::format("{}/{}", volt, ampere);
            henry = time.empty() ? "" : plain && time == "s" ? "H" : fmt::format("{} {}/{}", volt, time, ampere);
        }
        if (names.size() == 1) {
            found.x = header.time;
            found.y = header.channels[c];
            found.shown.push_back(shown_current(all, c, one));
        }
    });
    const auto put = [&](const char* name, const std::string& unit, const std::vector<Estimate>& sets) {
        if (!sets.empty())
            found.values.push_back({name, unit, combine(sets).mean});
        if (sets.size() > 1)
            found.values.push_back(
                {fmt::format("{}_spread_between_records", name), unit, {combine(sets).spread, 0, 0}});
    };
    put("resistance", ohm, resistances);
    put("inductance", henry, inductances);
    put("leakage_inductance", henry, leakages);
    for (std::size_t i = 0; i < frequencies.size(); ++i)
        found.values.push_back(
            {frequencies.size() == 1 ? "frequency" : "frequency of " + names[i], hertz, frequencies[i]});
    check_coil(found);
    set_variances(found);
    return found;
}

} // namespace graze
