#include "picture/period_table.hpp"

#include "graze/record/extremes.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/period.hpp"
#include "graze/record/section.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

namespace {

/// Base of tables whose rows are periods of the reference.
class PeriodTable : public RecordTable {
public:
    PeriodTable(const RecordTableRequest& request, bool several) : RecordTable(request, several) {}
    void add(const std::string& file, ProcessedRecord& record) override {
        header_ = record.header();
        channels_ = channels_of(header_);
        PeriodSettings settings;
        settings.reference = reference_ = header_.channel(request().reference, "reference");
        settings.level = request().level;
        settings.hysteresis = request().hysteresis;
        begin_record(file);
        const auto add = [&](const Period& period) {
            require_few_rows(rows());
            add_period(file, period);
        };
        end_record(file, each_period(record.source(), settings, add).amplitude);
    }

protected:
    virtual void begin_record(const std::string& file) = 0;
    virtual void add_period(const std::string& file, const Period& period) = 0;
    /// @param amplitude of the reference, averaged over the record
    virtual void end_record(const std::string& /*file*/, double /*amplitude*/) {}
    const RecordHeader& header() const { return header_; }
    const std::vector<std::size_t>& channels() const { return channels_; }
    std::size_t reference() const { return reference_; }
    std::string time_unit() const { return header_.time.unit; }

private:
    RecordHeader header_;
    std::vector<std::size_t> channels_;
    std::size_t reference_ = 0;
};

/// Begin and duration of periods, and the amplitude of each channel.
class Periods : public PeriodTable {
public:
    using PeriodTable::PeriodTable;
    Figure figure() const override {
        return {.panels = {{.x_label = "begin of period",
                            .y_label = "its duration",
                            .x_unit = time_unit(),
                            .y_unit = time_unit(),
                            .roomy_y = true,
                            .series = {{.points = points_}}}}};
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
        rows().add(static_cast<double>(period.number), period.begin, period.duration());
        for (const std::size_t c : channels())
            rows().add(amplitude(period, c));
        points_.push_back({period.begin, period.duration()});
    }

private:
    std::vector<PlanePoint> points_;
};

/// Points of sections. Diagrams are drawn over the amplitude of the reference, averaged over the record.
class Sections : public PeriodTable {
public:
    using PeriodTable::PeriodTable;
    Figure figure() const override {
        Figure figure;
        for (const std::size_t c : channels()) {
            FigurePanel panel;
            if (several())
                label_x(panel, {"amplitude of " + request().reference, header().channels[reference()].unit});
            else
                label_x(panel, header().time);
            label_y(panel, header().channels[c]);
            panel.roomy_y = panel.roomy_x = true;
            for (std::size_t phase = 0; phase < request().phases.size(); ++phase)
                for (const bool image : {false, true}) {
                    FigureSeries series{.colour = 2 * phase + (image ? 1 : 0)};
                    if (request().phases.size() > 1 || !request().negated.empty())
                        series.title = fmt::format("phase {}{}", request().phases[phase], image ? ", image" : "");
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
        if (!request().negated.empty())
            columns.push_back({"image", ""});
        columns.push_back({"time", time_unit()});
        columns.push_back({request().reference + "_amplitude", header().channels[reference()].unit});
        for (const std::size_t c : channels())
            columns.push_back({header().channels[c].name, header().channels[c].unit});
        begin(columns);
        symmetry_ = {};
        for (const std::string& name : request().negated)
            symmetry_.negated.push_back(header().channel(name, "negate"));
        first_ = drawn_.size();
    }
    void add_period(const std::string&, const Period& period) override {
        for (std::size_t phase = 0; phase < request().phases.size(); ++phase) {
            drawn_.push_back({section(period, request().phases[phase]), phase, 0});
            if (!request().negated.empty())
                drawn_.push_back({image_section(period, request().phases[phase], symmetry_), phase, 0});
        }
    }
    void end_record(const std::string& file, double amplitude) override {
        for (std::size_t i = first_; i < drawn_.size(); ++i) {
            Drawn& point = drawn_[i];
            point.amplitude = amplitude;
            begin_row(file);
            rows().add(static_cast<double>(point.section.period), request().phases[point.phase]);
            if (!request().negated.empty())
                rows().add(point.section.image ? "yes" : "no");
            rows().add(point.section.time, point.amplitude);
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
            columns.insert(columns.end(), {{channel.name + "_least", channel.unit},
                                           {channel.name + "_least_time", time_unit()},
                                           {channel.name + "_greatest", channel.unit},
                                           {channel.name + "_greatest_time", time_unit()},
                                           {channel.name + "_peak_to_peak", channel.unit}});
        }
        begin(columns);
        least_.resize(channels().size());
        greatest_.resize(channels().size());
    }
    void add_period(const std::string& file, const Period& period) override {
        begin_row(file);
        rows().add(static_cast<double>(period.number), period.begin);
        for (std::size_t k = 0; k < channels().size(); ++k) {
            const Extremes found = extremes(period, channels()[k]);
            rows().add(found.least, found.least_time, found.greatest, found.greatest_time, found.peak_to_peak());
            least_[k].push_back({period.begin, found.least});
            greatest_[k].push_back({period.begin, found.greatest});
        }
    }

private:
    std::vector<std::vector<PlanePoint>> least_, greatest_;
};

} // namespace

std::unique_ptr<RecordTable> period_table(const RecordTableRequest& request, bool several) {
    if (request.what == RecordTableRequest::What::periods)
        return std::make_unique<Periods>(request, several);
    if (request.what == RecordTableRequest::What::sections)
        return std::make_unique<Sections>(request, several);
    return std::make_unique<ExtremeTable>(request, several);
}

} // namespace graze
