#include "graze/results/table_recorder.hpp"

#include "graze/base/require.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/trajectory/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

class SampleTable : public TableRecorder {
public:
    SampleTable(const Simulation& simulation, const TableRequest& request)
        : model_(&simulation.model()), request_(request), columns_(*model_, request.quantities) {
        table_ = Table(columns_.after({{"time", model_->time_unit}, {"mode", ""}}));
    }

    void begin(const Trajectory& trajectory, std::optional<double> duration) override {
        // If the duration is unknown, the time between samples starts tiny and doubles whenever there are too many.
        const double unknown = std::exp2(-50);
        thins_ = !request_.every && !duration;
        columns_.set_parameters(trajectory.parameters());
        periods_ = trajectory.simulation().system().periods()(trajectory.parameters());
        const double spacing = request_.every ? *request_.every
                               : duration     ? *duration / static_cast<double>(request_.samples - 1)
                                              : unknown;
        const std::size_t count = request_.every || thins_ ? most_samples : request_.samples;
        sampler_.emplace(trajectory.time(), spacing, count, periods_,
                         [this](double time, std::size_t mode, std::span<const double> state) {
                             add(time, mode, state);
                             if (thins_ && table_.rows() == 2 * (request_.samples / 2)) {
                                 table_.drop_odd_rows();
                                 sampler_->coarsen();
                             }
                         });
    }

    void step(const Step& step) override { sampler_->step(step); }

    /// Adds a row for the end, unless the user has chosen the time between rows and the end is not one of these times.
    void finish(const Trajectory& trajectory) override {
        if (!sampler_)
            return;
        if (!is_complete())
            return;
        const bool due = sampler_->next() <= trajectory.time() + 1e-9 * sampler_->spacing();
        const bool missing = table_.rows() == 0 || last_ < trajectory.time();
        if (request_.every ? due : missing)
            add(trajectory.time(), trajectory.mode(), trajectory.state());
    }

    bool is_complete() const override { return table_.rows() < most_samples || !request_.every; }

private:
    void add(double time, std::size_t mode, std::span<const double> state) {
        last_ = time;
        table_.add(time, model_->modes[mode].name);
        columns_.add(table_, state);
    }

    const Model* model_;
    TableRequest request_;
    StateColumns columns_;
    std::vector<double> periods_;
    std::optional<Sampler> sampler_;
    bool thins_ = false;
    double last_ = 0;
};

/// A table whose rows show states with further quantities.
class StateTable : public TableRecorder {
public:
    void begin(const Trajectory& trajectory, std::optional<double> /*duration*/) override {
        columns_.set_parameters(trajectory.parameters());
    }

protected:
    StateTable(const Simulation& simulation, const TableRequest& request)
        : columns_(simulation.model(), request.quantities) {}
    StateColumns columns_;
};

class ContactTable : public StateTable {
public:
    ContactTable(const Simulation& simulation, const TableRequest& request)
        : StateTable(simulation, request), model_(&simulation.model()), shown_(request.events) {
        table_ = Table(columns_.after(columns_.after({{"time", model_->time_unit},
                                                      {"kind", ""},
                                                      {"event", ""},
                                                      {"transition", ""},
                                                      {"mode_before", ""},
                                                      {"mode_after", ""},
                                                      {"rate_before", ""},
                                                      {"rate_after", ""}}),
                                      "_after"));
    }

    void contact(const Contact& contact) override {
        if (!shown_[contact.event])
            return;
        const bool touch = contact.kind == ContactKind::touch;
        table_.add(contact.time,
                   touch                                   ? "touch"
                   : contact.kind == ContactKind::sticking ? "sticking"
                                                           : "crossing",
                   model_->events[contact.event].name, touch ? "" : model_->transitions[contact.transition].label,
                   model_->modes[contact.mode_before].name, model_->modes[contact.mode_after].name, contact.rate_before,
                   contact.rate_after);
        columns_.add(table_, contact.before);
        columns_.add(table_, contact.after);
    }

private:
    const Model* model_;
    std::vector<bool> shown_;
};

class SectionTable : public StateTable {
public:
    SectionTable(const Simulation& simulation, const TableRequest& request)
        : StateTable(simulation, request), simulation_(simulation), end_(request.first_extremum) {
        table_ = Table(
            columns_.after({{"section", ""}, {"time", simulation.model().time_unit}, {"direction", ""}, {"mode", ""}}));
    }

    void passage(const Passage& passage) override {
        if (passage.probe >= end_)
            return;
        table_.add(simulation_.probes()[passage.probe].name, passage.time, passage.direction,
                   simulation_.model().modes[passage.mode].name);
        columns_.add(table_, passage.state);
    }

private:
    Simulation simulation_;
    std::size_t end_;
};

class ExtremumTable : public StateTable {
public:
    ExtremumTable(const Simulation& simulation, const TableRequest& request)
        : StateTable(simulation, request), simulation_(simulation), first_(request.first_extremum),
          values_(simulation.model(), request.extrema) {
        table_ = Table(columns_.after({{"expression", ""},
                                       {"time", simulation.model().time_unit},
                                       {"kind", ""},
                                       {"value", ""},
                                       {"mode", ""},
                                       {"at_contact", ""}}));
    }

    void begin(const Trajectory& trajectory, std::optional<double> duration) override {
        StateTable::begin(trajectory, duration);
        values_.set_parameters(trajectory.parameters());
    }

    void passage(const Passage& passage) override {
        if (passage.probe < first_)
            return;
        table_.add(simulation_.probes()[passage.probe].name, passage.time,
                   passage.direction > 0 ? "minimum" : "maximum", values_(passage.state)[passage.probe - first_],
                   simulation_.model().modes[passage.mode].name, passage.at_contact ? 1 : 0);
        columns_.add(table_, passage.state);
    }

private:
    Simulation simulation_;
    std::size_t first_;
    QuantityEvaluator values_;
};

class MinimumTable : public TableRecorder {
public:
    MinimumTable(const Simulation& simulation, const TableRequest& request)
        : minima_([model = &simulation.model(), shown = request.events, this](const ArcMinimum& minimum) {
              if (!shown[minimum.event])
                  return;
              table_.add(static_cast<double>(minimum.arc), model->modes[minimum.mode].name, minimum.start, minimum.end,
                         model->events[minimum.event].name, minimum.time, minimum.value, minimum.lower_bound);
          }) {
        const std::string& unit = simulation.model().time_unit;
        table_ = Table({{"arc", ""},
                        {"mode", ""},
                        {"start", unit},
                        {"end", unit},
                        {"event", ""},
                        {"time", unit},
                        {"value", ""},
                        {"lower_bound", ""}});
    }

    void step(const Step& step) override { minima_.step(step); }
    void contact(const Contact& contact) override { minima_.contact(contact); }
    void minimum(const StepMinimum& minimum) override { minima_.minimum(minimum); }
    void finish(const Trajectory& /*trajectory*/) override { minima_.finish(); }

private:
    ArcMinima minima_;
};

class DerivativeTable : public TableRecorder {
public:
    DerivativeTable(const Simulation& simulation, const TableRequest& request) : model_(&simulation.model()) {
        std::vector<Table::Column> columns{{"state", ""}, {"value", ""}};
        for (const std::string& name : request.directions)
            columns.push_back({"d_" + name, ""});
        directions_ = request.directions.size();
        table_ = Table(std::move(columns));
    }

    void finish(const Trajectory& trajectory) override {
        const auto tangents = trajectory.tangents();
        for (std::size_t i = 0; i < model_->states.size(); ++i) {
            table_.add(model_->states[i].name, trajectory.state()[i]);
            for (std::size_t j = 0; j < directions_; ++j)
                table_.add(trajectory.tangents_valid() ? tangents[i * directions_ + j]
                                                       : std::numeric_limits<double>::quiet_NaN());
        }
    }

private:
    const Model* model_;
    std::size_t directions_;
};

class SummaryTable : public TableRecorder {
public:
    SummaryTable(const Simulation& simulation, const TableRequest& request)
        : model_(&simulation.model()), counted_(request.events), columns_(*model_, request.quantities) {
        table_ = Table(columns_.after({{"ending", ""},
                                       {"ending_time", model_->time_unit},
                                       {"steps", ""},
                                       {"contacts", ""},
                                       {"touches", ""},
                                       {"sticking", ""},
                                       {"mode", ""}}));
    }

    void contact(const Contact& contact) override {
        if (counted_[contact.event])
            ++(contact.kind == ContactKind::touch      ? touches_
               : contact.kind == ContactKind::sticking ? stickings_
                                                       : crossings_);
    }

    void finish(const Trajectory& trajectory) override {
        columns_.set_parameters(trajectory.parameters());
        table_.add(name_of(trajectory.outcome().ending), trajectory.outcome().time,
                   static_cast<double>(trajectory.steps()), crossings_, touches_, stickings_,
                   model_->modes[trajectory.mode()].name);
        columns_.add(table_, trajectory.state());
    }

private:
    const Model* model_;
    std::vector<bool> counted_;
    StateColumns columns_;
    double crossings_ = 0, touches_ = 0, stickings_ = 0;
};

template <class Recorder>
std::unique_ptr<TableRecorder> recorder_of_kind(const Simulation& simulation, const TableRequest& request) {
    return std::make_unique<Recorder>(simulation, request);
}

struct KindOfTable {
    std::string name;
    std::unique_ptr<TableRecorder> (*make)(const Simulation& simulation, const TableRequest& request);
};

/// In the order of TableKind.
const std::vector<KindOfTable>& kinds_of_tables() {
    static const std::vector<KindOfTable> kinds{
        {"samples", &recorder_of_kind<SampleTable>},   {"contacts", &recorder_of_kind<ContactTable>},
        {"sections", &recorder_of_kind<SectionTable>}, {"extrema", &recorder_of_kind<ExtremumTable>},
        {"minima", &recorder_of_kind<MinimumTable>},   {"derivatives", &recorder_of_kind<DerivativeTable>},
        {"summary", &recorder_of_kind<SummaryTable>}};
    return kinds;
}

} // namespace

std::optional<TableKind> table_kind(std::string_view name) {
    const auto found = std::ranges::find(kinds_of_tables(), name, &KindOfTable::name);
    return found == kinds_of_tables().end() ? std::nullopt
                                            : std::optional(static_cast<TableKind>(found - kinds_of_tables().begin()));
}

std::vector<std::string> table_kind_names() {
    return names_of(kinds_of_tables());
}

void require_room_for_samples(const TableRequest& request, std::optional<double> duration, const char* asked) {
    if (request.every && duration && *duration / *request.every > most_samples)
        throw InputError(Place{asked, 0, 0}, fmt::format("there would be more than {} rows", most_samples),
                         "choose a larger distance or a shorter time");
}

std::unique_ptr<TableRecorder> make_table_recorder(const Simulation& simulation, const TableRequest& request) {
    const auto kind = static_cast<std::size_t>(request.kind);
    require_index(kind, kinds_of_tables().size(), "kind of tables");
    auto recorder = kinds_of_tables()[kind].make(simulation, request);
    recorder->hold_at_most(request.most_cells);
    return recorder;
}

} // namespace graze
