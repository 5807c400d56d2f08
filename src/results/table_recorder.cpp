#include "graze/results/table_recorder.hpp"

#include "graze/trajectory/recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

namespace {

constexpr std::array<std::pair<std::string_view, TableKind>, 7> kinds{{
    {"samples", TableKind::samples},
    {"contacts", TableKind::contacts},
    {"sections", TableKind::sections},
    {"extrema", TableKind::extrema},
    {"minima", TableKind::minima},
    {"derivatives", TableKind::derivatives},
    {"summary", TableKind::summary},
}};

class SampleTable : public TableRecorder {
public:
    SampleTable(const Simulation& simulation, const TableRequest& request)
        : model_(&simulation.model()), request_(request), columns_(*model_, request.quantities) {
        std::vector<Table::Column> columns{{"time", model_->time_unit}, {"mode", ""}};
        columns_.declare(columns);
        table_ = Table(std::move(columns));
        periods_ = simulation.system().periods()(model_->parameter_values());
    }

    void begin(const Trajectory& trajectory, std::optional<double> duration) override {
        // If the duration is unknown, the time between samples starts tiny and doubles whenever there are too many.
        const double unknown = std::exp2(-50);
        thins_ = !request_.every && !duration;
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
        table_.add(time);
        table_.add(model_->modes[mode].name);
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

class ContactTable : public TableRecorder {
public:
    ContactTable(const Simulation& simulation, const TableRequest& request)
        : model_(&simulation.model()), shown_(request.events), columns_(*model_, request.quantities) {
        std::vector<Table::Column> columns{{"time", model_->time_unit}, {"kind", ""},        {"event", ""},
                                           {"transition", ""},          {"mode_before", ""}, {"mode_after", ""},
                                           {"rate_before", ""},         {"rate_after", ""}};
        columns_.declare(columns);
        columns_.declare(columns, "_after");
        table_ = Table(std::move(columns));
    }

    void contact(const Contact& contact) override {
        if (!shown_[contact.event])
            return;
        const bool touch = contact.kind == ContactKind::touch;
        table_.add(contact.time);
        table_.add(touch ? "touch" : contact.kind == ContactKind::sticking ? "sticking" : "crossing");
        table_.add(model_->events[contact.event].name);
        table_.add(touch ? "" : model_->transitions[contact.transition].label);
        table_.add(model_->modes[contact.mode_before].name);
        table_.add(model_->modes[contact.mode_after].name);
        table_.add(contact.rate_before);
        table_.add(contact.rate_after);
        columns_.add(table_, contact.before);
        columns_.add(table_, contact.after);
    }

private:
    const Model* model_;
    std::vector<bool> shown_;
    StateColumns columns_;
};

class SectionTable : public TableRecorder {
public:
    SectionTable(const Simulation& simulation, const TableRequest& request)
        : simulation_(simulation), end_(request.first_extremum), columns_(simulation.model(), request.quantities) {
        std::vector<Table::Column> columns{
            {"section", ""}, {"time", simulation.model().time_unit}, {"direction", ""}, {"mode", ""}};
        columns_.declare(columns);
        table_ = Table(std::move(columns));
    }

    void passage(const Passage& passage) override {
        if (passage.probe >= end_)
            return;
        table_.add(simulation_.probes()[passage.probe].name);
        table_.add(passage.time);
        table_.add(passage.direction);
        table_.add(simulation_.model().modes[passage.mode].name);
        columns_.add(table_, passage.state);
    }

private:
    Simulation simulation_;
    std::size_t end_;
    StateColumns columns_;
};

class ExtremumTable : public TableRecorder {
public:
    ExtremumTable(const Simulation& simulation, const TableRequest& request)
        : simulation_(simulation), first_(request.first_extremum), values_(simulation.model(), request.extrema),
          columns_(simulation.model(), request.quantities) {
        std::vector<Table::Column> columns{{"expression", ""}, {"time", simulation.model().time_unit},
                                           {"kind", ""},       {"value", ""},
                                           {"mode", ""},       {"at_contact", ""}};
        columns_.declare(columns);
        table_ = Table(std::move(columns));
    }

    void passage(const Passage& passage) override {
        if (passage.probe < first_)
            return;
        table_.add(simulation_.probes()[passage.probe].name);
        table_.add(passage.time);
        table_.add(passage.direction > 0 ? "minimum" : "maximum");
        table_.add(values_(passage.state)[passage.probe - first_]);
        table_.add(simulation_.model().modes[passage.mode].name);
        table_.add(passage.at_contact ? 1 : 0);
        columns_.add(table_, passage.state);
    }

private:
    Simulation simulation_;
    std::size_t first_;
    QuantityEvaluator values_;
    StateColumns columns_;
};

class MinimumTable : public TableRecorder {
public:
    MinimumTable(const Simulation& simulation, const TableRequest& request)
        : minima_([model = &simulation.model(), shown = request.events, this](const ArcMinimum& minimum) {
              if (!shown[minimum.event])
                  return;
              table_.add(static_cast<double>(minimum.arc));
              table_.add(model->modes[minimum.mode].name);
              table_.add(minimum.start);
              table_.add(minimum.end);
              table_.add(model->events[minimum.event].name);
              table_.add(minimum.time);
              table_.add(minimum.value);
              table_.add(minimum.lower_bound);
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
            table_.add(model_->states[i].name);
            table_.add(trajectory.state()[i]);
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
        std::vector<Table::Column> columns{{"ending", ""},  {"ending_time", model_->time_unit},
                                           {"steps", ""},   {"contacts", ""},
                                           {"touches", ""}, {"sticking", ""},
                                           {"mode", ""}};
        columns_.declare(columns);
        table_ = Table(std::move(columns));
    }

    void contact(const Contact& contact) override {
        if (counted_[contact.event])
            ++(contact.kind == ContactKind::touch      ? touches_
               : contact.kind == ContactKind::sticking ? stickings_
                                                       : crossings_);
    }

    void finish(const Trajectory& trajectory) override {
        table_.add(name_of(trajectory.outcome().ending));
        table_.add(trajectory.outcome().time);
        table_.add(static_cast<double>(trajectory.steps()));
        table_.add(crossings_);
        table_.add(touches_);
        table_.add(stickings_);
        table_.add(model_->modes[trajectory.mode()].name);
        columns_.add(table_, trajectory.state());
    }

private:
    const Model* model_;
    std::vector<bool> counted_;
    StateColumns columns_;
    double crossings_ = 0, touches_ = 0, stickings_ = 0;
};

} // namespace

std::optional<TableKind> table_kind(std::string_view name) {
    const auto* found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.first == name; });
    return found == kinds.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> table_kind_names() {
    std::vector<std::string> names;
    for (const auto& kind : kinds)
        names.emplace_back(kind.first);
    return names;
}

namespace {

std::unique_ptr<TableRecorder> make_recorder(const Simulation& simulation, const TableRequest& request) {
    switch (request.kind) {
    case TableKind::samples:
        return std::make_unique<SampleTable>(simulation, request);
    case TableKind::contacts:
        return std::make_unique<ContactTable>(simulation, request);
    case TableKind::sections:
        return std::make_unique<SectionTable>(simulation, request);
    case TableKind::extrema:
        return std::make_unique<ExtremumTable>(simulation, request);
    case TableKind::minima:
        return std::make_unique<MinimumTable>(simulation, request);
    case TableKind::derivatives:
        return std::make_unique<DerivativeTable>(simulation, request);
    case TableKind::summary:
        break;
    }
    return std::make_unique<SummaryTable>(simulation, request);
}

} // namespace

std::unique_ptr<TableRecorder> make_table_recorder(const Simulation& simulation, const TableRequest& request) {
    auto recorder = make_recorder(simulation, request);
    recorder->hold_at_most(request.most_cells);
    return recorder;
}

} // namespace graze
