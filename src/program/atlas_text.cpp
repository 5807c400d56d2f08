#include "program/atlas_text.hpp"

#include "program/wrapped_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_shown = 6; ///< of what was not gone on from

/// "1 curve", "3 curves", "no curves"
std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return count == 0 ? "no " + many : count == 1 ? "1 " + one : fmt::format("{} {}", count, many);
}

std::size_t meetings(const AtlasFindings& findings) {
    return static_cast<std::size_t>(std::ranges::count(findings.points, false, &AtlasPoint::on_row));
}

struct Confirmed {
    std::size_t stretches = 0, confirmed = 0;
};

Confirmed confirmed_of(const AtlasFindings& findings) {
    Confirmed result;
    for (const AtlasBranch& branch : findings.branches)
        for (const AtlasStretch& stretch : branch.stable) {
            ++result.stretches;
            result.confirmed += !stretch.confirmed.empty();
        }
    return result;
}

std::size_t sampled(const AtlasFindings& findings) {
    return static_cast<std::size_t>(std::ranges::count(findings.motions, false, &AtlasMotion::confirms));
}

std::string heading_of(const AtlasFindings& findings) {
    std::string text = fmt::format("Atlas '{}'", findings.run);
    for (std::size_t i = 0; i < findings.axes.size(); ++i) {
        const AtlasAxis& axis = findings.axes[i];
        text += fmt::format("{}{} from {:.6g} to {:.6g}{}{}", i == 0 ? ": " : ", ", axis.name, axis.least,
                            axis.greatest, axis.unit.empty() ? "" : " ", axis.unit);
    }
    return text + (!findings.finished ? "; not finished: the same command goes on\n"
                   : findings.limited ? "; a limit has ended it\n"
                                      : "\n");
}

std::string found_line(const AtlasFindings& findings) {
    const std::string branches = counted(findings.branches.size(), "branch", "branches");
    if (findings.rows.empty())
        return fmt::format("Found: {} with {}.\n", branches,
                           counted(findings.points.size(), "special point", "special points"));
    return fmt::format("Found: {} in {}, {}, and {} where curves meet or end.\n", branches,
                       counted(findings.rows.size(), "row", "rows"), counted(findings.curves.size(), "curve", "curves"),
                       counted(meetings(findings), "point", "points"));
}

std::string motions_lines(const AtlasFindings& findings) {
    const std::size_t invalid = findings.count(AtlasClaim::invalid);
    std::string text = counted(sampled(findings), "motion was simulated", "motions were simulated");
    if (invalid > 0)
        text += fmt::format(", of which {} could not begin, since the initial state is not possible", invalid);
    std::vector<std::string> parts;
    const auto add = [&](AtlasClaim claim, const std::string& words) {
        if (const std::size_t count = findings.count(claim); count > 0)
            parts.push_back(fmt::format("{}{}", count, words));
    };
    add(AtlasClaim::explained, fmt::format(" ({:.0f} %) on stable orbits of branches", 100 * findings.share()));
    add(AtlasClaim::beyond, " on periodic orbits beyond the limits");
    add(AtlasClaim::other, " not periodic");
    add(AtlasClaim::unexplained, findings.is_whole() ? " on orbits within the limits that no branch has"
                                                     : " on orbits that have not been followed");
    if (!parts.empty())
        text += fmt::format("{}: {}", invalid > 0 ? "; the others" : "", fmt::join(parts, ", "));
    return wrapped(text + ".") + '\n';
}

std::string checks_lines(const AtlasFindings& findings) {
    const auto [stretches, confirmed] = confirmed_of(findings);
    std::string text;
    if (stretches > 0)
        text += fmt::format("Simulation confirms {} of {}.\n", confirmed,
                            counted(stretches, "stable part of a branch", "stable parts of branches"));
    if (findings.changes > 0)
        text += fmt::format("Attractors differ between neighbouring rows at {}; a curve lies between them at {}.\n",
                            counted(findings.changes, "value", "values"), findings.crossed);
    return text;
}

std::string left_lines(const AtlasFindings& findings) {
    if (findings.remainders.empty())
        return "Everything within the limits was explored.\n";
    std::string text = "Not explored:\n";
    std::vector<AtlasRemainder> all = findings.remainders;
    std::ranges::stable_sort(all, std::greater(), &AtlasRemainder::count);
    for (std::size_t i = 0; i < std::min(most_shown, all.size()); ++i)
        text += "  " +
                wrapped(fmt::format("{} x {}, first at {}: {}", all[i].count, all[i].what, all[i].where, all[i].why),
                        common_line_width, 4) +
                '\n';
    if (all.size() > most_shown)
        text += fmt::format("  and {}\n", counted(all.size() - most_shown, "further kind", "further kinds"));
    return text;
}

} // namespace

std::string summary_text(const AtlasFindings& findings) {
    return heading_of(findings) + found_line(findings) + motions_lines(findings) + checks_lines(findings) +
           left_lines(findings);
}

void add_summary(JsonObject& heading, const AtlasFindings& findings) {
    heading.add("run", findings.run);
    heading.add("finished", findings.finished ? "yes" : "no");
    const auto number = [&](const char* name, std::size_t value) { heading.add(name, static_cast<double>(value)); };
    number("branches", findings.branches.size());
    number("curves", findings.curves.size());
    number("points", findings.points.size());
    number("motions", sampled(findings));
    number("explained", findings.count(AtlasClaim::explained));
    number("unexplained", findings.count(AtlasClaim::unexplained));
    number("beyond_limits", findings.count(AtlasClaim::beyond));
    number("not_periodic", findings.count(AtlasClaim::other));
    number("invalid", findings.count(AtlasClaim::invalid));
    const auto [stretches, confirmed] = confirmed_of(findings);
    number("stable_stretches", stretches);
    number("confirmed_stretches", confirmed);
    number("changes_between_rows", findings.changes);
    number("changes_crossed_by_curves", findings.crossed);
    number("left_out", findings.remainders.size());
}

bool has_contradiction(const AtlasFindings& findings) {
    const auto [stretches, confirmed] = confirmed_of(findings);
    return findings.is_whole() && (findings.count(AtlasClaim::unexplained) > 0 || confirmed < stretches);
}

} // namespace graze
