#include "graze/record/record_periods.hpp"
#include "graze/base/input_error.hpp"
#include "graze/record/extremes.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/section.hpp"
#include "program/record_tables.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <charconv>

namespace graze {

namespace {

/// Tables with rows for each period of the reference.
class PeriodTable : public RecordTable {
public:
    using RecordTable::RecordTable;
    void add(const std::string& file, RecordStages& stages) override {
        header_ = stages.header();
        channels_ = stages.channels(arguments().channels);
        PeriodSettings settings;
        settings.reference = reference_ = header_.channel(arguments().reference, "--reference");
        settings.level = arguments().level;
        settings.hysteresis = arguments().hysteresis;
        begin_record(file);
        const auto add = [&](const Period& period) {
            require_few_rows(rows());
            add_period(file, period);
        };
        end_record(file, each_period(stages.source(), settings, add, "--").amplitude);
    }

protected:
    virtual void begin_record(const std::string& file) = 0;
    virtual void add_period(const std::string& file, const Period& period) = 0;
    /// @param amplitude of the reference, averaged over the record
    virtual void end_record(const std::string& file, double amplitude) = 0;
    const RecordHeader& header() const { return header_; }
    const std::vector<std::size_t>& channels() const { return channels_; }
    std::size_t reference() const { return reference_; }
    std::string time_unit() const { return header_.time.unit; }

private:
    RecordHeader header_;
    std::vector<std::size_t> channels_;
    std::size_t reference_ = 0;
};

/// When periods begin, how long they are, amplitudes of all channels.
class Periods : public PeriodTable {
public:
    using PeriodTable::PeriodTable;
    Figure figure() const override {
        FigurePanel panel;
        label_x(panel, {"begin of period", time_unit()});
        label_y(panel, {"its duration", time_unit()});
        panel.roomy_y = true;
        panel.series.push_back({"", FigureSeries::Style::dots, 0, points_});
        Figure figure;
        figure.panels.push_back(std::move(panel));
        return figure;
    }

protected:
    void begin_record(const std::string&) override {
        std::vector<Table::Column> columns{{"period", ""}, {"begin", time_unit()}, {"duration", time_unit()}};
        for (const std::size_t c : channels())
            columns.push_back({header().channels[c].name + "_amplitude", header().channels[c].unit});
        begin(columns);
    }
    void add_period(const std::string& file, const Period& period) override {
        begin_row(file);
        rows().add(static_cast<double>(period.number));
        rows().add(period.begin);
        rows().add(period.duration());
        for (const std::size_t c : channels())
            rows().add(amplitude(period, c));
        points_.push_back({period.begin, period.duration()});
    }
    void end_record(const std::string&, double) override {}

private:
    std::vector<PlanePoint> points_;
};

std::vector<double> phases_of(const std::vector<std::string>& asked) {
    std::vector<double> phases;
    for (const std::string& text : split_list(asked)) {
        double value = 0;
        const char* const end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc() || next != end || !(value >= 0 && value < 1))
            throw InputError(Place{"--phase " + text, 0, 0}, "it is no part of a period",
                             "give numbers from 0 to less than 1, such as 0,0.25,0.5");
        phases.push_back(value);
    }
    if (phases.empty())
        phases.push_back(0);
    return phases;
}

/// Points of sections, with the mean amplitude of the reference in the whole record: what a diagram is drawn over.
class Sections : public PeriodTable {
public:
    Sections(const RecordArguments& given, bool many)
        : PeriodTable(given, many), phases_(phases_of(given.phases)), negated_(split_list(given.negated)) {}
    Figure figure() const override {
        Figure figure;
        for (const std::size_t c : channels()) {
            FigurePanel panel;
            if (several())
                label_x(panel, {"amplitude of " + arguments().reference, header().channels[reference()].unit});
            else
                label_x(panel, header().time);
            label_y(panel, header().channels[c]);
            panel.roomy_y = panel.roomy_x = true;
            for (std::size_t phase = 0; phase < phases_.size(); ++phase)
                for (const bool image : {false, true}) {
                    FigureSeries series;
                    series.colour = 2 * phase + (image ? 1 : 0);
                    if (phases_.size() > 1 || !negated_.empty())
                        series.title = fmt::format("phase {}{}", phases_[phase], image ? ", image" : "");
                    for (const Drawn& point : drawn_)
                        if (point.section.image == image && point.phase == phase)
                            series.points.push_back(
                                {several() ? point.amplitude : point.section.time, point.section.values[c]});
                    if (!series.points.empty())
                        panel.series.push_back(std::move(series));
                }
            figure.panels.push_back(std::move(panel));
        }
        return figure;
    }

protected:
    void begin_record(const std::string&) override {
        std::vector<Table::Column> columns{{"period", ""}, {"phase", ""}};
        if (!negated_.empty())
            columns.push_back({"image", ""});
        columns.push_back({"time", time_unit()});
        columns.push_back({arguments().reference + "_amplitude", header().channels[reference()].unit});
        for (const std::size_t c : channels())
            columns.push_back({header().channels[c].name, header().channels[c].unit});
        begin(columns);
        symmetry_ = {};
        for (const std::string& name : negated_)
            symmetry_.negated.push_back(header().channel(name, "--negate"));
        first_ = drawn_.size();
    }
    void add_period(const std::string&, const Period& period) override {
        for (std::size_t phase = 0; phase < phases_.size(); ++phase) {
            drawn_.push_back({section(period, phases_[phase]), phase, 0});
            if (negated_.empty())
                continue;
            drawn_.push_back({image_section(period, phases_[phase], symmetry_), phase, 0});
        }
    }
    void end_record(const std::string& file, double amplitude) override {
        for (std::size_t i = first_; i < drawn_.size(); ++i) {
            Drawn& point = drawn_[i];
            point.amplitude = amplitude;
            begin_row(file);
            rows().add(static_cast<double>(point.section.period));
            rows().add(phases_[point.phase]);
            if (!negated_.empty())
                rows().add(point.section.image ? "yes" : "no");
            rows().add(point.section.time);
            rows().add(point.amplitude);
            for (const std::size_t c : channels())
                rows().add(point.section.values[c]);
        }
    }

private:
    struct Drawn {
        SectionPoint section;
        std::size_t phase = 0; ///< index
        double amplitude = 0;
    };
    std::vector<double> phases_;
    std::vector<std::string> negated_;
    RecordSymmetry symmetry_;
    std::vector<Drawn> drawn_;
    std::size_t first_ = 0;
};

/// Least and greatest values in each period.
class ExtremeTable : public PeriodTable {
public:
    using PeriodTable::PeriodTable;
    Figure figure() const override {
        Figure figure;
        for (std::size_t k = 0; k < channels().size(); ++k) {
            FigurePanel panel;
            label_x(panel, {"begin of period", time_unit()});
            label_y(panel, header().channels[channels()[k]]);
            panel.roomy_y = true;
            panel.series.push_back({"greatest", FigureSeries::Style::dots, 0, greatest_[k]});
            panel.series.push_back({"least", FigureSeries::Style::dots, 1, least_[k]});
            figure.panels.push_back(std::move(panel));
        }
        return figure;
    }

protected:
    void begin_record(const std::string&) override {
        std::vector<Table::Column> columns{{"period", ""}, {"begin", time_unit()}};
        for (const std::size_t c : channels()) {
            const Channel& channel = header().channels[c];
            columns.push_back({channel.name + "_least", channel.unit});
            columns.push_back({channel.name + "_least_time", time_unit()});
            columns.push_back({channel.name + "_greatest", channel.unit});
            columns.push_back({channel.name + "_greatest_time", time_unit()});
            columns.push_back({channel.name + "_peak_to_peak", channel.unit});
        }
        begin(columns);
        least_.resize(channels().size());
        greatest_.resize(channels().size());
    }
    void add_period(const std::string& file, const Period& period) override {
        begin_row(file);
        rows().add(static_cast<double>(period.number));
        rows().add(period.begin);
        for (std::size_t k = 0; k < channels().size(); ++k) {
            const Extremes found = extremes(period, channels()[k]);
            for (const double value :
                 {found.least, found.least_time, found.greatest, found.greatest_time, found.peak_to_peak()})
                rows().add(value);
            least_[k].push_back({period.begin, found.least});
            greatest_[k].push_back({period.begin, found.greatest});
        }
    }
    void end_record(const std::string&, double) override {}

private:
    std::vector<std::vector<PlanePoint>> least_, greatest_;
};

} // namespace

std::unique_ptr<RecordTable> period_table(const RecordArguments& arguments) {
    const bool several = arguments.files.size() > 1;
    if (arguments.what == "periods")
        return std::make_unique<Periods>(arguments, several);
    if (arguments.what == "sections")
        return std::make_unique<Sections>(arguments, several);
    return std::make_unique<ExtremeTable>(arguments, several);
}

} // namespace graze
