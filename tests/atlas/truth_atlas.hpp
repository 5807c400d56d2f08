// Atlases of models whose orbits are known in closed form.

#pragma once

#include "base/temporary_folder.hpp"
#include "graze/atlas/atlas_findings.hpp"
#include "graze/atlas/run_atlas.hpp"
#include "graze/study/stored_study.hpp"
#include "places.hpp"
#include "truth/known.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace graze::testing {

inline std::string truth_model(const std::string& name) {
    return fmt::format("{}/tests/atlas/truth/{}.toml", source_folder, name);
}

/// A study with one run of kind atlas, called map.
inline std::string atlas_study(const std::string& model, const std::string& lines) {
    return fmt::format("name = \"s\"\nmodel = \"{}\"\n[runs.map]\nkind = \"atlas\"\n{}", model, lines);
}

/// Damped oscillator with a stop, by few samples.
inline std::string line_study() {
    return atlas_study(truth_model("impact-line"),
                       "vary = { omega = { from = 1.4, to = 2.6, points = 13 }, amplitude = [0.5, 1.3, 2.5, 5, 8] }\n"
                       "multiple = 1\ncontacts = 1\ndraws = 1\n");
}
/// The cubic map about its flips of period 1.
inline std::string flips_study(const std::string& limits) {
    return atlas_study(
        truth_model("cubic-map"),
        "vary = { a = { from = -1.4, to = 1.9, points = 12 }, b = [-1.5, -0.7, 0.6, 1.5] }\ndraws = 0\n" + limits);
}

/// A study and its results.
class AtlasResults {
public:
    explicit AtlasResults(const std::string& text, const NamedModels& models = {})
        : study(models.empty() ? read_study(folder_.write("s.toml", text)) : parse_study(text, "s.toml", {}, models)),
          file(folder_ / "results.sqlite", ResultFile::Access::write) {}

    std::vector<RunReport> run(const RunnerOptions& options = {}) {
        return run_with_atlases(study, file, options, [this](const Study& all, ResultFile& to, const auto& with) {
            ++rounds;
            return run_study(all, to, with);
        });
    }
    AtlasFindings findings() const { return atlas_findings(study, "map", file); }

private:
    TemporaryFolder folder_;

public:
    Study study;
    ResultFile file;
    int rounds = 0; ///< how often runs were computed
};

/// All that was found, in words and numbers. @param digits of parameter values
inline std::string text_of(const AtlasFindings& all, int digits = 17) {
    std::string text = fmt::format("finished {}, explained {}, changes {}, crossed {}\n", all.finished,
                                   all.count(AtlasClaim::explained), all.changes, all.crossed);
    for (const AtlasCurve& one : all.curves) {
        text += fmt::format("{} {} {} {} {} {}", one.name, one.run, one.multiple, one.contacts, one.line.size(),
                            one.crossings);
        for (const auto& end : {one.line.front(), one.line.back()})
            text += fmt::format(" {:.{}g} {:.{}g}", end[0], digits, end[1], digits);
        text += '\n';
    }
    for (const AtlasPoint& one : all.points) {
        text += fmt::format("{} {} {} {}", one.name, one.multiple, one.contacts, one.found.size());
        for (const double value : one.at)
            text += fmt::format(" {:.{}g}", value, digits);
        text += '\n';
    }
    for (const AtlasBranch& one : all.branches)
        text += fmt::format("{} {} {} {} {:.{}g} {:.{}g}\n", one.run, one.row, one.multiple, one.stable.size(),
                            one.least, digits, one.greatest, digits);
    for (const AtlasRemainder& one : all.remainders)
        text += fmt::format("{} {} {}\n", one.what, one.count, one.why);
    return text;
}

/// Distance of a point from the curve with these values of the second parameter.
inline double off_curve(const truth::NamedCurve& curve, const std::array<double, 2>& point) {
    double least = 1e300;
    for (const double value : curve.at(point[0]))
        least = std::min(least, std::abs(value - point[1]));
    return least;
}

/// The known curve on which a found one lies. @param beside distance from ends and turns within which points are left
/// out, since the closed form is ill-conditioned there
inline const truth::NamedCurve* known_curve(const AtlasCurve& found, const std::vector<truth::NamedCurve>& all,
                                            const std::vector<truth::Joint>& joints, double tolerance,
                                            double beside = 1e-4) {
    for (const truth::NamedCurve& one : all) {
        if (one.type != short_name(found.type) || one.period != found.multiple || one.contacts != found.contacts)
            continue;
        bool lies = true;
        for (const auto& point : found.line) {
            const bool is_joint = std::any_of(joints.begin(), joints.end(), [&](const truth::Joint& joint) {
                return std::hypot(joint.first - point[0], joint.second - point[1]) < beside;
            });
            lies = lies && (is_joint || off_curve(one, point) < tolerance);
        }
        if (lies)
            return &one;
    }
    return nullptr;
}

/// Whether some curve of the findings passes through a place within the distance of its points.
inline bool passes(const AtlasCurve& curve, double first, double second, double distance) {
    const auto& line = curve.line;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double dx = line[i + 1][0] - line[i][0], dy = line[i + 1][1] - line[i][1], square = dx * dx + dy * dy,
                     px = first - line[i][0], py = second - line[i][1];
        const double share = square > 0 ? std::clamp((px * dx + py * dy) / square, 0., 1.) : 0;
        if (std::hypot(px - share * dx, py - share * dy) < distance)
            return true;
    }
    return false;
}

/// Compares all that was found with a closed form: every curve lies on a known one, every place of a known one lies on
/// exactly one found curve of its type, every joint but the turns of curves is found, once, and nothing else.
inline void expect_truth(const AtlasFindings& found, const truth::Box& box,
                         const std::vector<truth::NamedCurve>& curves, const std::vector<truth::Joint>& joints) {
    constexpr double tolerance = 1e-9, near = 0.01;
    EXPECT_TRUE(found.finished);
    EXPECT_EQ(found.count(AtlasClaim::unexplained), 0U);
    for (const AtlasCurve& one : found.curves)
        EXPECT_NE(known_curve(one, curves, joints, tolerance), nullptr) << one.name;
    for (const truth::NamedCurve& known : curves)
        for (int i = 1; i < 40; ++i) {
            const double first = box.first_low + (box.first_high - box.first_low) * i / 40.3;
            for (const double second : known.at(first)) {
                if (!box.contains(first, second))
                    continue;
                const auto count = std::count_if(found.curves.begin(), found.curves.end(), [&](const AtlasCurve& one) {
                    return short_name(one.type) == known.type && one.multiple == known.period &&
                           one.contacts == known.contacts && passes(one, first, second, near);
                });
                EXPECT_EQ(count, 1) << known.type << known.period << " at " << first << ", " << second;
            }
        }
    std::vector<const truth::Joint*> places; // joints of several types at one place are one point
    for (const truth::Joint& joint : joints) {
        if (std::string_view(joint.type) == "EX")
            continue;
        const auto is_there = [&](double first, double second) {
            return std::hypot(first - joint.first, second - joint.second) < tolerance;
        };
        const auto count = std::count_if(found.points.begin(), found.points.end(), [&](const AtlasPoint& one) {
            return !one.on_row && is_there(one.at[0], one.at[1]);
        });
        EXPECT_EQ(count, 1) << joint.type << joint.period << " at " << joint.first << ", " << joint.second;
        if (std::none_of(places.begin(), places.end(),
                         [&](const truth::Joint* one) { return is_there(one->first, one->second); })) {
            places.push_back(&joint);
            EXPECT_EQ(std::count_if(found.points.begin(), found.points.end(),
                                    [&](const AtlasPoint& one) {
                                        return is_there(one.at[0], one.at.back()) &&
                                               one.name.find(joint.type) != std::string::npos;
                                    }),
                      1)
                << joint.type << joint.period;
        }
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(found.points.begin(), found.points.end(),
                                                     [](const AtlasPoint& one) { return !one.on_row; })),
              places.size());
}

} // namespace graze::testing
