#include "study/branch_run.hpp"

#include "branch/cycle_at_hopf.hpp"
#include "graze/branch/chatter_curve.hpp"
#include "graze/branch/curve_start.hpp"
#include "graze/branch/impacting_curve.hpp"
#include "graze/branch/switching.hpp"
#include "graze/orbit/orbit_file.hpp"
#include "orbit/cycle_homoclinics.hpp"
#include "study/branch_part.hpp"
#include "study/equilibrium_run.hpp"
#include "study/ladder_run.hpp"
#include "study/run_record.hpp"
#include "study/start_point.hpp"
#include "study/torus_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

/// An orbit with the signature that the run asks for; none when interrupted.
std::optional<Orbit> orbit_asked_for(const StudyRun& run, const System& system, const RunnerOptions& options) {
    Signature wanted = parse_signature(run.model, run.branch().signature, run.branch().signature_place);
    if (is_rest(wanted) && run.branch().signature.find(':') == std::string::npos)
        wanted = signature_of_rest(run.model.initial_mode);
    if (is_rest(wanted))
        return Orbit{wanted, run.model.parameter_values(), {run.model.initial_state()}, {0.0}, std::nullopt};
    SignatureSearchOptions search;
    search.unphysical = !run.branch().settings.stop_when_unphysical;
    search.interrupted = options.interrupted;
    const auto solution = at_place(run.branch().signature_place, run, [&] {
        return orbit_with_signature(system, wanted, run.branch().settings.orbit, run.branch().simulation, search);
    });
    return solution ? std::optional(solution->orbit) : std::nullopt;
}

/// The first guess from the run's table; its half if it converges to an orbit that is symmetric.
Orbit orbit_of_table(const StudyRun& run, const System& system) {
    const BranchRequest& branch = run.branch();
    const Orbit candidate =
        branch.table_text.empty()
            ? read_orbit_table(run.model, branch.table, branch.signature)
            : parse_orbit_table(run.model, branch.table_text, branch.signature, fmt::format("table of '{}'", run.name));
    if (run.model.symmetries.empty())
        return candidate;
    return at_place(run.place, run, [&] {
        const OrbitSolution solution = solve_orbit(system, candidate, run.branch().settings.orbit);
        const bool converged = solution.outcome == OrbitOutcome::converged;
        return (converged ? half_orbit(system, solution.orbit) : std::nullopt).value_or(candidate);
    });
}

/// The orbit on which a motion from the model's initial state settles; none when interrupted.
std::optional<Orbit> settled(const StudyRun& run, const System& system, const RunnerOptions& options) {
    const auto interrupted = [&] { return options.interrupted && options.interrupted(); };
    const auto solution = at_place(run.place, run, [&] {
        const BranchRequest& branch = run.branch();
        return find_orbit(system, branch.attractor, branch.settings.orbit, branch.simulation, interrupted);
    });
    return solution ? std::optional(solution->orbit) : std::nullopt;
}

/// The system with the parameters, the initial state and the mode of a point of another run.
System system_at(const StudyRun& run, const StartPoint& start) {
    Model model = run.model;
    set_parameters(model, start.parameters);
    for (std::size_t i = 0; i < model.states.size(); ++i)
        model.set_initial(model.states[i].name, start.point.result.state[i]);
    model.set_initial_mode(model.modes[start.point.result.mode].name);
    return System(model);
}

/// An orbit of another run, at the parameters that this run sets.
Orbit with_parameters_of_run(const StudyRun& run, Orbit orbit) {
    orbit.parameters = with_own_parameters(run, std::move(orbit.parameters));
    return orbit;
}

std::vector<BranchPart> in_directions(const std::vector<std::string>& names, const Orbit& orbit) {
    std::vector<BranchPart> parts;
    for (const std::string& name : names)
        parts.push_back({name, orbit, std::nullopt, name == "down" ? -1 : 1, !parts.empty(), ""});
    return parts;
}

std::vector<BranchPart> both_directions(const StudyRun& run, const Orbit& orbit) {
    return in_directions(direction_names(run), orbit);
}

/// The image of an orbit under the model's symmetry.
Orbit symmetric_image(const StudyRun& run, const System& system, const Orbit& orbit) {
    if (run.model.symmetries.empty())
        throw InputError(run.start->place, fmt::format("model '{}' declares no symmetry", run.model.name),
                         "declare one in the model");
    // The orbit whose first half is this one has its image as the second half.
    Orbit half = orbit;
    half.symmetry = orbit.symmetry.value_or(0);
    const Orbit whole = whole_orbit(system, half);
    const std::size_t count = orbit.segments();
    if (whole.segments() != 2 * count)
        throw InputError(run.start->place, "the image of an orbit that ends at a section cannot be taken",
                         "begin from another initial state");
    Orbit image = orbit;
    const auto from = static_cast<std::ptrdiff_t>(count);
    image.signature.assign(whole.signature.begin() + from, whole.signature.end());
    image.starts.assign(whole.starts.begin() + from, whole.starts.end());
    return image;
}

/// The remedy where it is not clear which curve through a point is to be followed.
std::string which_curves(const System& system, const SpecialPoint& point) {
    std::vector<std::string> ways;
    std::vector<PointType> types = curves_at(point);
    for (const PointType type : impacting_curves_at(system, point))
        if (std::find(types.begin(), types.end(), type) == types.end())
            types.push_back(type);
    for (const PointType type : types)
        ways.push_back(fmt::format("onto = \"{}\"", short_name(type)));
    return ways.empty() ? "choose another point, or hold a monitor: fixed = true"
                        : fmt::format("say which curve through it is meant: {}", fmt::join(ways, " or "));
}

/// The touch of a curve on which a vanishing sensitivity is held too, for which one more parameter is free.
SpecialPoint touch_to_keep(const StudyRun& run, const SpecialPoint& point) {
    const PointType asked = point_type(run.start->onto).value_or(point.type);
    if (point.type != PointType::sensitivity || asked != PointType::sensitivity)
        throw InputError(run.start->place,
                         fmt::format("two further parameters are free, and points of type {} ({}) need one",
                                     short_name(asked), name_of(asked)),
                         "leave `free` out, or start from a vanishing sensitivity (VS) on a curve of touches");
    return at_place(run.start->place, run, [&] { return as_type(point, PointType::grazing); });
}

/// The point, as one of the type whose curve is followed.
SpecialPoint point_to_keep(const StudyRun& run, const System& system, const SpecialPoint& given) {
    const SpecialPoint point = at_place(run.start->place, run, [&] { return hopf_of_equilibrium(system, given); });
    const PointType asked = point_type(run.start->onto).value_or(point.type);
    if (!kind_of(asked).may_be_kept)
        throw InputError(run.start->place,
                         fmt::format("points of type {} ({}) cannot be followed as a curve", short_name(point.type),
                                     name_of(point.type)),
                         which_curves(system, point) +
                             (asked == PointType::sensitivity
                                  ? "; the curve of such points needs a third parameter: free = { PARAMETER = [..] }"
                                  : ""));
    return at_place(run.start->place, run, [&] {
        const std::vector<PointType> impacting = impacting_curves_at(system, point);
        return std::find(impacting.begin(), impacting.end(), asked) != impacting.end()
                   ? on_impacting_curve(system, point, asked, run.branch().settings)
                   : as_type(point, asked);
    });
}

/// Both directions along the curve through a point. From a resonance a curve of torus points leads in one direction
/// only, and so does a curve of folds or flips from a contact without speed; which direction is not known beforehand.
std::vector<BranchPart> parts_of_curve(const StudyRun& run, const System& system, const SpecialPoint& point) {
    if (!run.branch().keeps_point())
        return both_directions(run, with_parameters_of_run(run, point.solution.orbit));
    const bool twice = run.branch().kept_conditions() == 2;
    const SpecialPoint kept = twice ? touch_to_keep(run, point) : point_to_keep(run, system, point);
    const Orbit orbit = with_parameters_of_run(run, kept.solution.orbit);
    const bool resonant = point.type == PointType::resonance_1 || point.type == PointType::resonance_2;
    const bool begins_contact = kept.solution.orbit.signature != point.solution.orbit.signature;
    std::vector<BranchPart> parts = begins_contact || (resonant && kept.type == PointType::torus)
                                        ? in_directions({"up", "down"}, orbit)
                                        : both_directions(run, orbit);
    for (BranchPart& part : parts) {
        part.kept = kept;
        if (twice)
            part.kept_too = PointType::sensitivity;
    }
    return parts;
}

/// Both directions along the branches of orbits that are homoclinic to a cycle; none when interrupted.
std::vector<BranchPart> parts_of_homoclinics(const StudyRun& run, const System& system, const Orbit& cycle,
                                             const RunnerOptions& options) {
    const std::vector<OrbitSolution> found = at_place(run.start->place, run, [&] {
        return homoclinic_orbits(system, with_parameters_of_run(run, cycle), run.branch().settings.orbit,
                                 options.interrupted);
    });
    if (options.interrupted && options.interrupted())
        return {};
    std::vector<BranchPart> parts;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (BranchPart part : both_directions(run, found[i].orbit)) {
            if (found.size() > 1)
                part.name = fmt::format("{} {}", i + 1, part.name);
            parts.push_back(std::move(part));
        }
    return parts;
}

std::vector<BranchPart> parts_from_orbit(const StudyRun& run, const System& system, const StudyRun& parent,
                                         const OrbitRecord& record, const RunnerOptions& options) {
    const StartFrom& start = *run.start;
    const SpecialPoint& point = record.point;
    if (point.type == PointType::chatter)
        throw InputError(start.place, "contacts accumulate at an onset of chatter: no orbit begins there",
                         "start from a grazing of the ladder, or follow the onset with kind = \"curve\"");
    if (run.kind == RunKind::curve)
        return parts_of_curve(run, system, point);
    if (is_homoclinic(point.solution.orbit.signature))
        throw InputError(start.place,
                         "a homoclinic orbit exists at one value of a parameter only: no branch begins there",
                         "follow it in two parameters: kind = \"curve\", free = { PARAMETER = [..] }");
    if (start.onto == "homoclinic")
        return parts_of_homoclinics(run, system, point.solution.orbit, options);
    const bool same_parameter = (parent.kind == RunKind::follow || parent.kind == RunKind::ladder) &&
                                parent.branch().settings.parameter == run.branch().settings.parameter &&
                                parent.branch().settings.family == run.branch().settings.family;
    std::string onto = start.onto;
    if (onto.empty())
        onto = kind_of(point.type).has_bifurcating_branch && same_parameter && !point.solution.orbit.cycle ? "other"
                                                                                                           : "same";
    if (point.solution.orbit.cycle && onto != "same")
        throw InputError(start.place,
                         fmt::format("no branch of type \"{}\" leaves an orbit that is homoclinic to a cycle", onto),
                         "follow the orbit itself: onto = \"same\"");
    if (onto == "twin")
        return both_directions(
            run, at_place(start.place, run, [&] { return symmetric_image(run, system, point.solution.orbit); }));
    if (onto == "same")
        return both_directions(run, with_parameters_of_run(run, point.solution.orbit));
    if (!same_parameter && point.type == PointType::branch_point)
        throw InputError(start.place, "another branch is left for only along the parameter of the first",
                         "follow the same parameter first");
    const auto starts = at_place(start.place, run, [&] { return branches_at(system, point, run.branch().settings); });
    if (!run.set.empty()) // at other parameters there is no direction yet
        return both_directions(run, with_parameters_of_run(run, starts.front().orbit));
    std::vector<BranchPart> parts;
    for (const BranchStart& one : starts)
        parts.push_back({one.how, one.orbit, one, 1, false,
                         point.type == PointType::asymmetry && !parts.empty() ? parts.front().name : ""});
    return parts;
}

/// The parts of a run of orbits or branches. @param first the orbit of another run from which it starts, if any
/// @return no parts when interrupted
std::vector<BranchPart> parts_of(const Study& study, const StudyRun& run, const System& system, SharedFile& file,
                                 const std::optional<OrbitRecord>& first, const RunnerOptions& options) {
    const BranchRequest& branch = run.branch();
    if (first)
        return parts_from_orbit(run, system, run_named(study, run.start->run), *first, options);
    if (run.start) {
        const StartPoint start =
            file.with([&](const ResultFile& results) { return point_to_start_from(run, study, results); });
        const auto orbit = settled(run, system_at(run, start), options);
        return orbit ? both_directions(run, *orbit) : std::vector<BranchPart>();
    }
    if (branch.has_table())
        return both_directions(run, orbit_of_table(run, system));
    const auto orbit = branch.signature.empty() ? settled(run, system, options) : orbit_asked_for(run, system, options);
    return orbit ? both_directions(run, *orbit) : std::vector<BranchPart>();
}

/// The orbit from which a run starts; none if it does not start from an orbit.
std::optional<OrbitRecord> first_orbit(const Study& study, const StudyRun& run, SharedFile& file) {
    if (!run.start || !run_named(study, run.start->run).is_branch())
        return std::nullopt;
    const StudyRun& parent = run_named(study, run.start->run);
    OrbitRecord record =
        file.with([&](const ResultFile& results) { return orbit_to_start_from(*run.start, parent, results); });
    if (record.torus)
        throw InputError(
            run.start->place,
            fmt::format("run '{}' has tori, and no orbits to start from but those of its points PL", parent.name),
            "start from one of these, or from a branch of orbits");
    if (record.point.type == PointType::locking) // a fold of an orbit, as any other
        record.point.type = PointType::fold;
    return record;
}

/// Refuses a curve that does not leave its first point.
[[noreturn]] void refuse_curve(const StudyRun& run, const SpecialPoint& kept, const std::string& why) {
    throw InputError(run.start->place,
                     fmt::format("run '{}': no curve of points of type {} ({}) begins there: {}; {}", run.name,
                                 short_name(kept.type), name_of(kept.type), why, multipliers_in_words(kept)),
                     "choose another point, or another of the curves through it by `onto`");
}

/// Counts the parts of a run that end at their first orbit. The run fails where steps cannot be made, and where all
/// parts end at their first orbit for whatever reason.
class Standstill {
public:
    void note(const BranchPart& part, const PartEnd& end) {
        if (end.left || end.outcome == BranchOutcome::no_start) // of which the file says so
            return;
        ++parts_;
        const bool fails = end.outcome == BranchOutcome::no_convergence || end.outcome == BranchOutcome::undefined ||
                           end.outcome == BranchOutcome::too_long;
        if (why_.empty() || (fails && !fails_))
            why_ = fmt::format("{}: {}", part.name, end.why);
        fails_ = fails_ || fails;
    }
    /// @param parts of the run
    void report(std::size_t parts, RunReport& report) const {
        if (!fails_ && parts_ < parts)
            return;
        if (parts_ == 0)
            return;
        report.problem = fmt::format("the branch does not leave its first orbit, {}", why_);
        report.remedy = fails_ ? "begin elsewhere, or with shorter steps: step = { first = 1e-4, smallest = 1e-10 }"
                               : "choose the other direction, wider bounds, or another orbit to begin with";
    }

private:
    std::size_t parts_ = 0;
    bool fails_ = false;
    std::string why_;
};

bool compute_orbit(const Study& study, const StudyRun& run, const System& system, SharedFile& file,
                   const std::optional<OrbitRecord>& first, const RunnerOptions& options, PointWriter& writer) {
    const std::vector<BranchPart> parts = parts_of(study, run, system, file, first, options);
    if (parts.empty())
        return false;
    const BranchPart& part = parts.front();
    const SpecialPoint point = point_of_solution(
        run, system,
        at_place(run.place, run, [&] { return solve_orbit(system, part.orbit, run.branch().settings.orbit); }));
    writer.add("", point, is_stable(point.solution));
    writer.end("");
    return true;
}

/// Follows an onset of chatter in two parameters. @return whether it was finished rather than interrupted
bool follow_chatter(const StudyRun& run, const System& system, const SpecialPoint& first, PointWriter& writer,
                    const RunnerOptions& options) {
    const auto refuse = [&](const std::string& problem, const std::string& remedy) {
        throw InputError(run.start->place, fmt::format("run '{}' follows an onset of chatter: {}", run.name, problem),
                         remedy);
    };
    if (!run.start->onto.empty())
        refuse(fmt::format("it is no point of type {}", run.start->onto), "leave `onto` out");
    const BranchSettings& settings = run.branch().settings;
    try {
        require_chatter_curve(run.model, first, settings);
    } catch (const InputError& error) {
        refuse(error.problem(), error.remedy());
    }
    ChatterCurve curve = at_place(run.start->place, run, [&] { return ChatterCurve(system, first, settings); });
    const std::vector<std::string> parts = direction_names(run);
    for (const std::string& part : parts) {
        const auto write = [&] {
            SpecialPoint point = curve.point();
            if (curve.steps() == 0 && part == parts.front()) // the other part has the same first point
                point.type = PointType::chatter;
            point.monitors = monitors_of(system, point.solution.orbit, run);
            writer.add(part, point, false);
        };
        curve.start(part == "down" ? -1 : 1);
        write();
        while (curve.step(options.interrupted))
            write();
        if (curve.interrupted())
            return false;
        writer.end(curve.ending());
    }
    return true;
}

} // namespace

bool run_branch(const Study& study, const StudyRun& run, SharedFile& file, const RunnerOptions& options,
                RunReport& report) {
    const System system = at_place(run.place, run, [&] { return System(run.model); });
    PointWriter writer(run, file, options, report);
    report.points = 0;
    const std::optional<OrbitRecord> first = first_orbit(study, run, file);
    if (run.kind == RunKind::orbit)
        return compute_orbit(study, run, system, file, first, options, writer);
    if (run.kind == RunKind::equilibrium)
        return run_equilibrium(study, run, system, file, options, report, writer);
    if (run.kind == RunKind::ladder || run.kind == RunKind::torus) {
        const bool ladder = run.kind == RunKind::ladder;
        if (!first)
            throw InputError(run.start->place,
                             fmt::format("run '{}' has no {}", run.start->run, ladder ? "grazings" : "torus points"),
                             "start from a run of kind \"continue\"");
        return ladder ? run_ladder(run, system, *first, writer, options)
                      : run_torus(run, system, *first, writer, options);
    }
    if (run.kind == RunKind::curve && first && run.branch().keeps_point() && first->point.type == PointType::chatter)
        return follow_chatter(run, system, first->point, writer, options);
    const std::vector<BranchPart> parts = parts_of(study, run, system, file, first, options);
    if (parts.empty())
        return false;
    bool any = false;
    std::string why;
    Standstill standstill;
    for (BranchPart part : parts) {
        writer.set_image_of(part.image_of);
        if (part.kept && !any)
            part.again = false;
        const auto end = follow_part(run, run.branch().settings, system, part, writer, options);
        if (end.interrupted)
            return false;
        if (part.kept && !end.begun && end.outcome == BranchOutcome::no_start)
            refuse_curve(run, *part.kept, end.why);
        any = any || end.begun;
        if (!end.begun)
            why = end.why;
        standstill.note(part, end);
        if (end.outcome == BranchOutcome::closed)
            break; // the other way round is the same
    }
    if (parts.front().kept && !any)
        refuse_curve(run, *parts.front().kept, why);
    standstill.report(parts.size(), report);
    return true;
}

} // namespace graze
