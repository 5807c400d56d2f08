#include "graze/study/run_part.hpp"

#include "graze/base/require.hpp"
#include "graze/model/model_file.hpp"
#include "graze/study/stored_study.hpp"
#include "study/point_bytes.hpp"
#include "study/run_record.hpp"
#include "study/same_version.hpp"
#include "study/settings_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

namespace graze {

namespace {

/// The first bytes of parts and of points; they change with what follows.
const std::string part_mark = "graze-part-2\n", points_mark = "graze-points-1\n";

std::unique_ptr<SearchFactory> searches_of(const StudyRun& run, const System& system) {
    const MotionRequest& motion = run.motion();
    AttractorOptions attractor = motion.attractor;
    attractor.stay_in_transients = run.is_swept() && motion.carry;
    return seeks_attractors(run.kind)
               ? attractor_searches(system, attractor, motion.samplings, run.values, motion.simulation)
               : transient_searches(system, motion.transient, motion.samplings, run.values, motion.simulation);
}

/// A run and its start, as they are written.
struct StartedRun : WrittenRun {
    std::optional<PointRecord> start;
};

template <class Fields, class Run>
void describe_started(Fields& fields, Run& run) {
    describe_written(fields, run);
    if (!fields.has("state", run.start.has_value()))
        return;
    if constexpr (Fields::reading)
        run.start.emplace();
    describe_fields(fields, "state", run.start->result.state, "mode", run.start->result.mode);
}

StartedRun read_started(const std::string& text) {
    const Place place{"part of a run", 0, 0};
    const Json json = parse_json(text, place);
    SettingsReader fields(json, nullptr, place);
    StartedRun run;
    describe_started(fields, run);
    require_same_version(run.asked.version, place.file);
    run.asked.file = place.file;
    return run;
}

StudyRun started_run(const StartedRun& started) {
    Model model = parse_model(started.model, "model of a part of a run");
    const bool fits = !started.start || (started.start->result.state.size() == model.states.size() &&
                                         started.start->result.mode < model.modes.size());
    if (!fits)
        throw InputError("the start of a part of a run does not fit its model", "let it be written again");
    StudyRun run = run_of(started.asked, std::move(model));
    if (!run.has_motions())
        throw InputError(fmt::format("a run of kind {} has no parts", name_of(run.kind)), "use a sweep or a basin");
    return run;
}

template <class Bytes, class Result>
void describe_result(Bytes& bytes, Result& result) {
    bytes.choice(result.label, Label::failed);
    bytes(result.period, result.duration, result.signature, result.symmetric, result.multipliers, result.eigenvalues,
          result.residual, result.lyapunov, result.lyapunov_error, result.cycles, result.periods_run, result.time,
          result.state, result.mode);
    bytes.choice(result.outcome.ending, Ending::step_limit);
    bytes(result.outcome.time, result.outcome.detail, result.samples.width, result.samples.samplings,
          result.samples.times, result.samples.values);
}

/// @throws InputError when more chains are known than the part has
void require_consistent(const RunPart& part) {
    if (part.chains.first > part.chains.last || part.known.bound() > part.chains.size())
        ByteReader::fail();
}

} // namespace

struct PartedRun::State {
    State(const StudyRun& of_run, const PointRecord* from)
        : run(of_run), start(from ? std::optional(*from) : std::nullopt), system(run.model),
          plan(plan_of(run, system, from)), searches(searches_of(run, system)) {}

    StudyRun run;
    std::optional<PointRecord> start;
    System system;
    Plan plan;
    std::unique_ptr<SearchFactory> searches;
};

PartedRun::PartedRun(const StudyRun& run, const PointRecord* start)
    : state_(std::make_unique<const State>(run, start)) {}

PartedRun::PartedRun(const std::string& text) {
    const StartedRun started = read_started(text);
    state_ = std::make_unique<const State>(started_run(started), started.start ? &*started.start : nullptr);
}

PartedRun::~PartedRun() = default;

std::string PartedRun::text() const {
    const StartedRun started{written(state_->run), state_->start};
    SettingsWriter fields;
    describe_started(fields, started);
    return fields.text();
}

const StudyRun& PartedRun::run() const {
    return state_->run;
}

std::size_t PartedRun::chains() const {
    return state_->plan.chains;
}

std::size_t PartedRun::chain_length() const {
    return state_->plan.chain_length;
}

bool PartedRun::compute(ItemRange chains, const KnownChains& known, const ExecutionOptions& options,
                        const PointSink& sink) const {
    require_room(this->chains(), chains.last, "chains of a part");
    require_room(chains.last, chains.first, "chains before a part");
    const Plan& whole = state_->plan;
    const std::size_t before = chains.first * whole.chain_length;
    Plan plan = whole;
    plan.chains = chains.size();
    plan.start = [&whole, before](std::size_t point) { return whole.start(before + point); };
    return execute(plan, *state_->searches, known, options,
                   [&](std::size_t point, const PointStart&, PointResult& result) { sink(before + point, result); });
}

std::string bytes_of(const RunPart& part) {
    ByteWriter bytes(part_mark);
    bytes(part.chains.first, part.chains.last, part.known.ended().size(), part.known.begun().size());
    for (const auto& [first, last] : part.known.ended())
        bytes(first, last);
    for (const auto& [number, chain] : part.known.begun())
        bytes(number, chain.done, chain.regular, chain.state, chain.mode);
    return bytes.take();
}

RunPart part_of(std::string_view bytes) {
    ByteReader reader(bytes, part_mark);
    RunPart part;
    std::size_t ended = 0, begun = 0;
    reader(part.chains.first, part.chains.last, ended, begun);
    for (; ended > 0; --ended) {
        ItemRange range;
        reader(range.first, range.last);
        if (range.first > range.last)
            ByteReader::fail();
        part.known.end(range);
    }
    for (; begun > 0; --begun) {
        std::size_t number = 0;
        ChainProgress chain;
        reader(number, chain.done, chain.regular, chain.state, chain.mode);
        part.known.begin(number, std::move(chain));
    }
    reader.require_end();
    require_consistent(part);
    return part;
}

std::string computed_points(const PartedRun& run, const RunPart& part, const std::function<bool()>& interrupted,
                            const PieceSink& sink, std::chrono::milliseconds between) {
    using Clock = std::chrono::steady_clock;
    require_consistent(part);
    for (const auto& [number, chain] : part.known.begun())
        if (chain.done > 0 && chain.done < run.chain_length() &&
            (chain.state.size() != run.run().model.states.size() || chain.mode >= run.run().model.modes.size()))
            ByteReader::fail();
    ExecutionOptions options;
    options.interrupted = interrupted;
    ByteWriter bytes(points_mark);
    Clock::time_point begun = Clock::now();
    const bool complete = run.compute(part.chains, part.known, options, [&](std::size_t point, PointResult& result) {
        bytes(point);
        describe_result(bytes, result);
        if (!sink || Clock::now() < begun + between)
            return;
        sink(bytes.take());
        bytes = ByteWriter(points_mark);
        begun = Clock::now();
    });
    return complete ? bytes.take() : std::string();
}

PointsReader::PointsReader(const PartedRun& run, RunPart part) : run_(&run), part_(std::move(part)) {
    require_consistent(part_);
    if (part_.chains.last > run.chains())
        ByteReader::fail();
    next_.resize(part_.chains.size());
    for (std::size_t chain = 0; chain < next_.size(); ++chain)
        next_[chain] = part_.known.done(chain, run.chain_length());
}

void PointsReader::read(std::string_view piece, bool is_last, const PointSink& sink) {
    ByteReader reader(piece, points_mark);
    std::vector<std::pair<std::size_t, PointResult>> points;
    while (!reader.is_at_end()) {
        auto& [number, result] = points.emplace_back();
        reader(number);
        describe_result(reader, result);
    }
    // Chains alternate where they were computed side by side, in another way on each machine.
    std::ranges::sort(points, {}, &std::pair<std::size_t, PointResult>::first);
    const std::size_t length = run_->chain_length();
    std::vector<std::size_t> next = next_;
    for (const auto& [number, result] : points) {
        const std::size_t chain = number / length;
        if (chain < part_.chains.first || chain >= part_.chains.last ||
            number % length != next[chain - part_.chains.first]++)
            ByteReader::fail();
    }
    if (is_last && std::ranges::any_of(next, [&](std::size_t one) { return one != length; }))
        ByteReader::fail();
    next_ = std::move(next);
    for (auto& [number, result] : points)
        sink(number, result);
}

void read_points(const PartedRun& run, const RunPart& part, std::string_view bytes, const PointSink& sink) {
    PointsReader(run, part).read(bytes, true, sink);
}

} // namespace graze
