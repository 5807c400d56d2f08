#include "program/live_picture.hpp"

#include "graze/picture/figure_script.hpp"
#include "graze/picture/record_table.hpp"
#include "graze/record/record_file.hpp"
#include "graze/record/section.hpp"
#include "program/drawing.hpp"
#include "program/process.hpp"

namespace graze {

namespace {

constexpr auto between_pictures = std::chrono::seconds(5);
constexpr std::size_t most_periods = 2000; ///< of a record that are drawn

} // namespace

LivePicture::LivePicture(const AcquireArguments& arguments) : arguments_(&arguments) {
    picture_ending(arguments.live, "--live", {"svg", "png", "pdf", "eps"});
    if (!find_program("gnuplot"))
        throw InputError(Place{"--live", 0, 0}, "gnuplot, which draws it, is not there",
                         "install gnuplot, or leave --live out");
    FigurePanel panel;
    label_x(panel, {"amplitude, peak to peak", "V"});
    panel.roomy_y = true;
    for (const char* title : {"up", "down"})
        panel.series.push_back({title, FigureSeries::Style::dots, panel.series.size(), {}});
    figure_.panels.push_back(std::move(panel));
}

void LivePicture::add(const std::string& file, double amplitude, int direction) {
    const std::shared_ptr<SampleSource> record = open_record(file);
    const RecordHeader& header = record->header();
    PeriodSettings settings;
    if (!arguments_->reference.empty())
        settings.reference = header.channel(arguments_->reference, "--reference");
    const std::size_t shown =
        arguments_->channel.empty() ? header.channels.size() - 1 : header.channel(arguments_->channel, "--channel");
    FigurePanel& panel = figure_.panels.front();
    label_y(panel, header.channels[shown]);
    PeriodSplitter splitter(record, settings);
    Period period;
    for (std::size_t i = 0; i < most_periods && splitter.next(period); ++i)
        panel.series[direction < 0 ? 1 : 0].points.push_back(
            {amplitude, section(period, arguments_->phase).values[shown]});
    changed_ = true;
}

void LivePicture::draw(bool now) {
    const auto time = std::chrono::steady_clock::now();
    if (!changed_ || (!now && time - last_ < between_pictures))
        return;
    Figure figure = figure_;
    std::erase_if(figure.panels.front().series, [](const FigureSeries& series) { return series.points.empty(); });
    if (figure.panels.front().series.empty())
        return;
    draw_figure(figure, arguments_->live, "");
    last_ = time;
    changed_ = false;
}

} // namespace graze
