#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/model_table.hpp"
#include "graze/results/table_recorder.hpp"
#include "graze/study/run_length.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/output_file.hpp"
#include "program/plot.hpp"
#include "program/status_line.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace graze {

namespace {

Model prepared_model(const SimulateArguments& arguments) {
    Model model = load_model(arguments.model);
    set_parameters(model, arguments.set);
    set_initial_state(model, arguments.from);
    if (!arguments.mode.empty())
        model.set_initial_mode(arguments.mode);
    return model;
}

SimulationOptions simulation_options(const Model& model, const SimulateArguments& arguments, TableKind kind) {
    SimulationOptions options = arguments.method;
    options.minima = kind == TableKind::minima;
    if (!arguments.largest_step.empty())
        options.largest_step = positive_value_of(model, arguments.largest_step, "--largest-step");
    options.validate();
    return options;
}

/// The table that --table names, or that the other options imply.
TableKind chosen_table(const SimulateArguments& arguments) {
    if (!arguments.table.empty()) {
        if (const auto kind = table_kind(arguments.table))
            return *kind;
        throw InputError({"--table", 0, 0}, fmt::format("there is no table '{}'", arguments.table),
                         name_advice(arguments.table, table_kind_names(), ""));
    }
    std::vector<TableKind> implied;
    if (!arguments.sections.empty())
        implied.push_back(TableKind::sections);
    if (!arguments.extrema.empty())
        implied.push_back(TableKind::extrema);
    if (arguments.minima)
        implied.push_back(TableKind::minima);
    if (!arguments.derivatives.empty())
        implied.push_back(TableKind::derivatives);
    if (arguments.contacts || (arguments.length.contacts && implied.empty()))
        implied.push_back(TableKind::contacts);
    if (implied.size() > 1)
        throw InputError("these options ask for several tables", "choose one by --table, for example --table contacts");
    return implied.empty() ? TableKind::samples : implied.front();
}

/// True when a table is printed: always without --plot; beside a picture only if an option asks for the table.
bool wants_table(const SimulateArguments& arguments, bool output_options) {
    return arguments.plot.empty() || output_options || !arguments.table.empty() || !arguments.output.file.empty();
}

std::vector<bool> chosen_events(const Model& model, const std::vector<std::string>& names) {
    std::vector<bool> chosen(model.events.size(), names.empty());
    for (const std::string& name : split_list(names)) {
        const auto index = model.find_event(name);
        if (!index)
            throw InputError({"--event", 0, 0}, fmt::format("the model has no event '{}'", name),
                             name_advice(name, names_of(model.events), "it has none"));
        chosen[*index] = true;
    }
    return chosen;
}

std::vector<std::string> chosen_directions(const Model& model, const SimulateArguments& arguments, TableKind kind) {
    if (kind != TableKind::derivatives)
        return {};
    const std::vector<std::string> chosen = split_list(arguments.derivatives);
    std::vector<std::string> known = names_of(model.states);
    for (const std::string& name : model.independent_parameters())
        known.push_back(name);
    if (chosen.empty() || chosen == std::vector<std::string>{"all"})
        return known;
    for (const std::string& name : chosen)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"--derivatives", 0, 0},
                             model.find_parameter(name) ? fmt::format("the parameter '{}' follows from others", name)
                                                        : fmt::format("the model has no state or parameter '{}'", name),
                             name_advice(name, known, ""));
    return chosen;
}

TableRequest table_request(const Model& model, const SimulateArguments& arguments) {
    TableRequest request;
    request.kind = chosen_table(arguments);
    request.quantities = requested_quantities(model, arguments.quantities, "--quantity");
    request.extrema = requested_quantities(model, arguments.extrema, "--extrema");
    request.events = chosen_events(model, arguments.events);
    request.directions = chosen_directions(model, arguments, request.kind);
    if ((arguments.samples || !arguments.every.empty()) && request.kind != TableKind::samples)
        throw InputError("--samples and --every choose rows of the table `samples`, which is not shown",
                         "leave them out, or ask for --table samples");
    if (arguments.samples && (*arguments.samples < 2 || static_cast<std::size_t>(*arguments.samples) > most_samples))
        throw InputError({"--samples", 0, 0}, fmt::format("{} rows are out of range", *arguments.samples),
                         fmt::format("give 2 or more, up to {}", most_samples));
    if (arguments.samples)
        request.samples = static_cast<std::size_t>(*arguments.samples);
    if (!arguments.every.empty())
        request.every = positive_value_of(model, arguments.every, "--every");
    if (request.kind == TableKind::extrema && request.extrema.empty())
        throw InputError("nothing says whose extrema to show",
                         "name expressions by --extrema, for example --extrema q");
    return request;
}

RunLength asked_length(const Model& model, const SimulateArguments& arguments) {
    RunLengthRequest request = arguments.length;
    if (!arguments.time.empty())
        request.time = positive_value_of(model, arguments.time, "--time");
    if (!arguments.after.empty())
        request.after = positive_value_of(model, arguments.after, "--after");
    return run_length(model, request);
}

/// The probes of the simulation: sections, extrema, then the probe that counts periods. It is the last since it ends
/// the trajectory: events of the others at the same time are recorded before.
std::vector<Probe> probes_for(const Model& model, const SimulateArguments& arguments, TableRequest& request,
                              const RunLength& length) {
    std::vector<Probe> probes;
    std::vector<std::string> sections = split_list(arguments.sections);
    if (sections.empty() && request.kind == TableKind::sections)
        for (const Section& section : model.sections)
            sections.push_back(section.name);
    if (sections.empty() && request.kind == TableKind::sections)
        throw InputError(fmt::format("model '{}' has no sections", model.name),
                         "declare one under [sections] in the model file");
    for (const std::string& name : sections)
        probes.push_back(section_probe(model, name));
    request.first_extremum = probes.size();
    for (const RequestedQuantity& extremum : request.extrema) {
        Probe probe;
        probe.name = extremum.name;
        probe.kind = Probe::Kind::extremum;
        probe.expression = extremum.value;
        probes.push_back(std::move(probe));
    }
    if (length.period)
        probes.push_back(*length.period);
    return probes;
}

constexpr int calls_between_clock_reads = 64;

/// The line of progress of a long simulation on standard error: its time and the time left.
class Progress {
public:
    Progress(const Console& console, bool wanted) : line_(console, wanted) {}

    /// @param fraction of the simulation that is done; none when its length is not known
    void update(std::optional<double> fraction, double time) {
        if (!line_.wanted() || ++calls_ < calls_between_clock_reads)
            return;
        calls_ = 0;
        if (!line_.is_due())
            return;
        const double elapsed = line_.elapsed();
        std::string line = fmt::format("time {:.6g}", time);
        if (fraction && *fraction > 0)
            line += fmt::format(", {:.0f} %, {:.0f} s left", 100 * *fraction, elapsed * (1 - *fraction) / *fraction);
        line_.show(line);
    }

private:
    StatusLine line_;
    int calls_ = 0;
};

/// One execution of `graze simulate`: checks the options, computes, and writes table, picture and outcome.
class SimulateCommand {
public:
    SimulateCommand(const SimulateArguments& arguments, const Console& console)
        : arguments_(arguments), console_(console), model_(prepared_model(arguments)),
          request_(table_request(model_, arguments)), length_(asked_length(model_, arguments)) {
        require_room_for_samples(request_, length_.shown.expected, "--every");
        check_outputs();
        const SimulationOptions options = simulation_options(model_, arguments, request_.kind);
        auto probes = probes_for(model_, arguments, request_, length_);
        period_probe_ = length_.period ? std::optional(probes.size() - 1) : std::nullopt;
        simulation_ =
            std::make_unique<Simulation>(System(model_), std::move(probes), std::vector<Expression>{}, options);
        table_ = make_table_recorder(*simulation_, request_);
        if (plot_)
            curves_ = std::make_shared<MotionRecorder>(*simulation_, plot_->contents);
    }

    int run() {
        compute();
        table_->finish(*trajectory_);
        if (wants_table_)
            deliver(table_->table(), arguments_.output, heading(), console_, names_of(request_.quantities));
        const int code = report();
        if (plot_) {
            curves_->finish(*trajectory_);
            if (!curves_->is_complete())
                console_.err << "graze: warning: the run is too long for one picture, which shows only its beginning; "
                                "use --skip and a shorter time\n";
            draw_plot(*plot_, *curves_);
        }
        return code;
    }

private:
    /// Checks the outputs before the computation, whose results would otherwise be lost.
    void check_outputs() {
        wants_table_ = wants_table(arguments_, arguments_.output.format != TableFormat::table);
        if (wants_table_ && !arguments_.output.file.empty())
            require_writable(arguments_.output.file);
        if (arguments_.plot.empty() && (!arguments_.plot_data.empty() || !arguments_.portraits.empty()))
            throw InputError("--portrait and --data say something about a picture that is not asked for",
                             "add --plot FILE.svg");
        if (!arguments_.plot.empty())
            plot_ = plot_request(model_, arguments_, request_.events);
    }

    void compute() {
        std::vector<std::shared_ptr<Observer>> observers{table_};
        if (curves_)
            observers.push_back(curves_);
        Progress progress(console_, arguments_.progress || console_.terminal);
        const auto control =
            std::make_shared<RunControl>(std::make_shared<Relay>(std::move(observers)), period_probe_, request_.events);
        control->tell([&](std::optional<double> fraction, double time) { progress.update(fraction, time); });
        control->end_when([this] { return InterruptGuard::requested() || table_->is_full(); });
        trajectory_ = std::make_unique<Trajectory>(*simulation_, model_.parameter_values(), control);
        const InterruptGuard guard;
        trajectory_->start(model_.initial_state(), model_.initial_mode, 0, length_.first().duration);
        if (!request_.directions.empty())
            trajectory_->carry_derivatives(request_.directions);
        JetSet jets(*simulation_, LaneKind::single);
        run_legs(*trajectory_, jets, *control, length_, &InterruptGuard::requested,
                 [this] { table_->begin(*trajectory_, length_.shown.expected); });
        interrupted_ = InterruptGuard::exit_code();
    }

    std::string ending_name() const {
        return interrupted_ > 0 ? "interrupted"
               : is_full()      ? "table-full"
                                : std::string(name_of(trajectory_->outcome().ending));
    }

    JsonObject heading() const {
        JsonObject parameters, initial, outcome, heading, parameter_units, state_units;
        const std::vector<double> values = all_parameter_values(model_);
        for (std::size_t i = 0; i < values.size(); ++i)
            parameters.add(model_.parameters[i].name, values[i]);
        const std::vector<double> states = model_.initial_state();
        for (std::size_t i = 0; i < states.size(); ++i)
            initial.add(model_.states[i].name, states[i]);
        for (const Parameter& parameter : model_.parameters)
            parameter_units.add(parameter.name, parameter.unit);
        for (const State& state : model_.states)
            state_units.add(state.name, state.unit);
        outcome.add("ending", ending_name());
        outcome.add("time", trajectory_->outcome().time);
        outcome.add("detail", trajectory_->outcome().detail);
        heading.add("graze", GRAZE_VERSION);
        heading.add("model", model_.name);
        heading.add("parameters", parameters);
        heading.add("parameter_units", parameter_units);
        heading.add("state_units", state_units);
        heading.add("time_unit", model_.time_unit);
        heading.add("initial_mode", model_.modes[model_.initial_mode].name);
        heading.add("initial", initial);
        heading.add("tolerance", simulation_->options().tolerance);
        heading.add("order", simulation_->order());
        heading.add("outcome", outcome);
        return heading;
    }

    /// True when the run ended because the table has as many rows as it can hold.
    bool is_full() const { return table_->is_full() && trajectory_->outcome().ending == Ending::stopped; }

    /// Prints how the trajectory ended. @return the exit code
    int report() const {
        const Outcome& outcome = trajectory_->outcome();
        const std::string unit = model_.time_unit.empty() ? "" : ' ' + model_.time_unit;
        const bool regular = is_regular(outcome.ending);
        const std::string when = fmt::format("at time {:.15g}{}", outcome.time, unit);
        if (interrupted_ > 0)
            console_.err << "graze: interrupted " << when << '\n';
        else if (is_full())
            console_.err << fmt::format("graze: the table is full {}, with {} rows; ask for a shorter time, fewer "
                                        "events or quantities, or --table summary\n",
                                        when, table_->table().rows());
        else if (!regular)
            console_.err << fmt::format("graze: {} {}: {}\n", name_of(outcome.ending), when, outcome.detail);
        else if (outcome.ending == Ending::singular)
            console_.err << fmt::format("graze: snap-through/singularity {}\n", when);
        else if (!arguments_.quiet)
            console_.err << fmt::format("graze: {} {}, {} steps\n", name_of(outcome.ending), when,
                                        trajectory_->steps());
        if (!table_->is_complete())
            console_.err << fmt::format("graze: warning: the table ends after {} rows; choose a larger --every\n",
                                        table_->table().rows());
        bool undefined = false;
        if (request_.kind == TableKind::derivatives && !trajectory_->tangents_valid()) {
            const bool to_end = interrupted_ == 0 && outcome.ending == Ending::end_time;
            console_.err << (to_end
                                 ? "graze: no derivatives exist after a contact without speed, or where they are not "
                                   "finite; start elsewhere, or end before it\n"
                                 : "graze: there are no derivatives where the motion has ended; end before it\n");
            undefined = true;
        } else if (const auto names = table_->table().incomplete_columns(); !names.empty()) {
            console_.err << fmt::format("graze: warning: {} has no finite value in some rows, where cells are empty\n",
                                        name_list(names));
        }
        return interrupted_ > 0 ? interrupted_ : regular && !undefined && !is_full() ? exit_success : exit_irregular;
    }

    const SimulateArguments& arguments_;
    const Console& console_;
    Model model_;
    TableRequest request_;
    RunLength length_;
    bool wants_table_ = true;
    int interrupted_ = 0; ///< exit code of an interrupted run
    std::optional<PlotRequest> plot_;
    std::optional<std::size_t> period_probe_;
    std::unique_ptr<Simulation> simulation_;
    std::shared_ptr<TableRecorder> table_;
    std::shared_ptr<MotionRecorder> curves_;
    std::unique_ptr<Trajectory> trajectory_;
};

} // namespace

int simulate_command(const SimulateArguments& arguments, const Console& console) {
    return SimulateCommand(arguments, console).run();
}

} // namespace graze
