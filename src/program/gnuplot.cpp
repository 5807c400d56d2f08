#include "program/gnuplot.hpp"

#include "picture/gnuplot_text.hpp"
#include "program/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace graze {

namespace {

// Lengths are pixels of a picture at 96 per inch.
constexpr double history_width = 480, history_height = 125, history_gap = 14;
constexpr double smallest_portrait = 230, largest_portrait = 320, portrait_gap = 62;
constexpr double bottom_margin = 52, top_margin = 34, right_margin = 18, left_margin = 8;
constexpr double pixels_of_letter = 6.4, pixels_of_digit = 7.2, pixels_of_line = 17, pixels_of_tic = 75;
constexpr double invisible = 2e-4; ///< of a panel's size

/// The documentation of a quantity, up to the first remark, on one line.
std::string short_text(const RequestedQuantity& quantity) {
    return one_line(quantity.text.substr(0, quantity.text.find_first_of(";,(")));
}

/// Breaks a text into two lines that fit; empty when it does not.
std::string in_two_lines(const std::string& text, std::size_t letters) {
    if (text.size() <= letters)
        return text;
    for (std::size_t half = text.size() / 2, away = 0; away <= half; ++away)
        for (const std::size_t at : {half - away, half + away})
            if (at < text.size() && text[at] == ' ' && at <= letters && text.size() - at - 1 <= letters)
                return text.substr(0, at) + '\n' + text.substr(at + 1);
    return "";
}

/// The same for double quotes, each line as plain text.
std::string lines(const std::string& text) {
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? plain(text) : plain(text.substr(0, end)) + "\\n" + plain(text.substr(end + 1));
}

std::size_t letters_of_tics(const Axis& axis) {
    std::size_t letters = 0;
    const double first = std::ceil(axis.low / axis.tic);
    constexpr int most = 100; // far more than there is room for
    for (int i = 0; i < most && (first + i) * axis.tic <= axis.high; ++i)
        letters = std::max(letters, fmt::format("{:.6g}", (first + i) * axis.tic).size());
    return letters;
}

} // namespace

GnuplotScript::GnuplotScript(const PlotRecorder& recorder, const FigureStyle& style)
    : recorder_(&recorder), style_(style) {
    constexpr double usual_size = 9, pixels_of_mm = 96 / 25.4;
    if (style.font_size > 0)
        unit_ = style.font_size / usual_size;
    asked_width_ = style.width * pixels_of_mm / unit_;
    asked_height_ = style.height * pixels_of_mm / unit_;
    make_panels();
    place_panels();
    for (const PlotRecorder::Jump& jump : recorder.jumps())
        has_marks_ = has_marks_ || jump.marked;
    for (Panel& panel : panels_)
        write_data(panel);
}

void GnuplotScript::make_panels() {
    const PlotContents& contents = recorder_->contents();
    const std::vector<std::size_t> histories = shown_histories();
    for (const std::size_t column : histories) {
        Panel panel;
        panel.x.is_time = true;
        panel.y.column = column;
        panel.name = fmt::format("history{}", panels_.size() + 1);
        panel.x_labels = panels_.size() + 1 == histories.size();
        panels_.push_back(panel);
    }
    for (std::size_t i = 0; i < contents.portraits.size(); ++i) {
        Panel panel;
        panel.x.column = contents.portraits[i].first;
        panel.y.column = contents.portraits[i].second;
        panel.name = fmt::format("portrait{}", i + 1);
        panels_.push_back(panel);
    }
}

bool GnuplotScript::changes(std::size_t column) const {
    const std::size_t columns = recorder_->contents().columns.size();
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const PlotRecorder::Arc& arc : recorder_->arcs())
        for (std::size_t i = 0; i < arc.times.size(); ++i) {
            least = std::min(least, arc.values[i * columns + column]);
            greatest = std::max(greatest, arc.values[i * columns + column]);
        }
    constexpr double resolved = 1e-9; // as axis_for draws a constant
    return greatest - least > resolved * std::max(std::abs(least), std::abs(greatest));
}

std::vector<std::size_t> GnuplotScript::shown_histories() const {
    const PlotContents& contents = recorder_->contents();
    std::vector<std::size_t> shown;
    for (const std::size_t column : contents.histories)
        if (contents.chosen || changes(column))
            shown.push_back(column);
    return shown.empty() ? contents.histories : shown;
}

void GnuplotScript::place_panels() {
    place_columns();
    if (asked_width_ == 0)
        return;
    fit_width(asked_width_);
    constexpr double least_stretch = 0.55; // beside one another, panels would be too narrow
    const bool both = panels_.front().x.is_time && !panels_.back().x.is_time;
    if (both && stretch_ < least_stretch) {
        stacked_ = true;
        stretch_ = 1;
        place_columns();
        fit_width(asked_width_);
    }
}

void GnuplotScript::fit_width(double asked) {
    constexpr int rounds = 4; // numbers beside the axes depend on their lengths
    constexpr double narrowest = 0.2;
    for (int round = 0; round < rounds; ++round) {
        double panels = 0;
        for (const bool over_time : {true, false})
            for (const Panel& panel : panels_)
                if (panel.x.is_time == over_time) {
                    panels = stacked_ ? std::max(panels, panel.width) : panels + panel.width;
                    break;
                }
        stretch_ = std::max(narrowest, stretch_ * (asked - (width_ - panels)) / panels);
        place_columns();
    }
    width_ = asked;
}

/// Heights first; they decide about tics and labels, which decide how much room the columns need beside them.
void GnuplotScript::place_columns() {
    double histories = 0, portraits = 0;
    for (const Panel& panel : panels_)
        (panel.x.is_time ? histories : portraits) += 1;
    const double above = top_margin + bottom_margin;
    double one = history_height;
    double inner = histories > 0 ? histories * one + (histories - 1) * history_gap : 0;
    const double gaps = (portraits - 1) * portrait_gap;
    const double least = smallest_portrait * std::min(stretch_, 1.0), most = largest_portrait * std::max(stretch_, 1.0);
    double side = portraits > 0 ? std::clamp((inner - gaps) / portraits * stretch_, least, most) : 0;
    if (stacked_)
        side = history_width * stretch_;
    double portrait_height =
        portraits > 0 ? std::min((std::max(inner, portraits * side + gaps) - gaps) / portraits, 1.4 * side) : 0;
    if (stacked_)
        portrait_height = 0.8 * side;
    const double of_portraits = portraits > 0 ? portraits * portrait_height + gaps : 0;
    double rows = stacked_ ? inner + portrait_gap + of_portraits : std::max(inner, of_portraits);
    if (asked_height_ > 0) {
        constexpr double flattest = 24;
        const double free = (stacked_ ? histories * one + portraits * portrait_height : rows);
        const double factor =
            std::max(flattest * std::max(histories, portraits), asked_height_ - above - (rows - free)) / free;
        one *= factor;
        portrait_height = stacked_ ? portrait_height * factor : (rows * factor - gaps) / std::max(portraits, 1.0);
        rows = (rows - free) + free * factor;
    }
    if (!stacked_ && histories > 0)
        one = (rows - (histories - 1) * history_gap) / histories;
    height_ = rows + above;
    double top = height_ - top_margin, portrait_top = top;
    if (stacked_)
        portrait_top = top - histories * one - (histories - 1) * history_gap - portrait_gap;
    for (Panel& panel : panels_) {
        panel.width = panel.x.is_time ? history_width * stretch_ : side;
        panel.height = panel.x.is_time ? one : portrait_height;
        double& next = panel.x.is_time ? top : portrait_top;
        panel.bottom = next - panel.height;
        next = panel.bottom - (panel.x.is_time ? history_gap : portrait_gap);
        panel.x_axis =
            axis_of(panel.x, std::max(2, static_cast<int>(panel.width / pixels_of_tic)), panel.x.is_time ? 0 : 0.05);
        panel.y_axis = axis_of(panel.y, std::max(2, static_cast<int>(panel.height / 35)), 0.08);
    }
    choose_labels();
    const double beside = histories > 0 ? place_column(0, true) + right_margin : 0;
    width_ = portraits > 0 ? place_column(stacked_ ? 0 : beside, false) + right_margin : beside;
    width_ = std::max(width_, beside);
}

/// Aligns the panels of a column and their labels. Returns where it ends.
double GnuplotScript::place_column(double start, bool over_time) {
    double tics = 0, label_lines = 1;
    for (const Panel& panel : panels_) {
        if (panel.x.is_time != over_time)
            continue;
        tics = std::max(tics, static_cast<double>(letters_of_tics(panel.y_axis)));
        if (label(panel.y, panel.height + history_gap, true).find("\\n") != std::string::npos)
            label_lines = 2;
    }
    double end = start;
    for (Panel& panel : panels_) {
        if (panel.x.is_time != over_time)
            continue;
        panel.label = start + left_margin + label_lines * pixels_of_line / 2;
        panel.left = start + 3 * left_margin + label_lines * pixels_of_line + tics * pixels_of_digit;
        end = panel.left + panel.width;
    }
    return end;
}

/// Where the solution ends in a singularity some states grow without bounds: the last moments are left to run out
/// of the picture.
Axis GnuplotScript::axis_of(const Coordinate& coordinate, int tics, double margin) const {
    const auto& arcs = recorder_->arcs();
    if (arcs.empty())
        return {};
    const double start = arcs.front().times.front(), end = arcs.back().times.back();
    if (coordinate.is_time)
        return axis_for(start, recorder_->singularity().value_or(end), tics, recorder_->singularity() ? 0.01 : margin);
    const double last = recorder_->singularity() ? end - 0.005 * (end - start) : end;
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    const std::size_t columns = recorder_->contents().columns.size();
    for (const PlotRecorder::Arc& arc : arcs)
        for (std::size_t i = 0; i < arc.times.size() && arc.times[i] <= last; ++i) {
            const double value = arc.values[i * columns + coordinate.column];
            if (std::isfinite(value)) {
                least = std::min(least, value);
                greatest = std::max(greatest, value);
            }
        }
    Axis axis = axis_for(least, greatest, tics, margin);
    require_drawable(axis.low, axis.high, recorder_->contents().columns[coordinate.column].name);
    return axis;
}

/// Words where they fit everywhere, otherwise names.
void GnuplotScript::choose_labels() {
    long_labels_ = true;
    for (const Panel& panel : panels_) {
        long_labels_ = long_labels_ && !label(panel.y, panel.height + history_gap, true).empty();
        if (!panel.x.is_time)
            long_labels_ = long_labels_ && !label(panel.x, panel.width, false).empty();
    }
}

std::string GnuplotScript::label(const Coordinate& coordinate, double room, bool two_lines) const {
    if (coordinate.is_time)
        return with_unit("time", recorder_->time_unit());
    const RequestedQuantity& quantity = recorder_->contents().columns[coordinate.column];
    if (!long_labels_)
        return with_unit(name_text(quantity.name), quantity.unit);
    const auto letters = static_cast<std::size_t>(room / pixels_of_letter);
    const std::string words = short_text(quantity);
    const std::size_t room_of_unit = quantity.unit.empty() ? 0 : quantity.unit.size() + 3;
    const std::string broken = in_two_lines(words + std::string(room_of_unit, '#'), letters);
    if (words.empty() || broken.empty() || (!two_lines && broken.find('\n') != std::string::npos))
        return "";
    return with_unit(lines(broken.substr(0, broken.size() - room_of_unit)), quantity.unit);
}

void GnuplotScript::write_curve(const Panel& panel) {
    const std::size_t columns = recorder_->contents().columns.size();
    const double width = panel.x_axis.high - panel.x_axis.low, height = panel.y_axis.high - panel.y_axis.low;
    Polyline line;
    const auto flush = [&] {
        for (const PlanePoint& point : simplified(line, width, height, invisible))
            write_point(point);
        if (!line.empty())
            data_ += '\n';
        line.clear();
    };
    for (const PlotRecorder::Arc& arc : recorder_->arcs()) {
        for (std::size_t i = 0; i < arc.times.size(); ++i) {
            const double* values = &arc.values[i * columns];
            const PlanePoint point{value(panel.x, arc.times[i], values), value(panel.y, arc.times[i], values)};
            // A phase that begins anew, or a quantity without a value, interrupts the line.
            const bool wraps =
                !line.empty() && ((period(panel.x) > 0 && std::abs(point.x - line.back().x) > period(panel.x) / 2) ||
                                  (period(panel.y) > 0 && std::abs(point.y - line.back().y) > period(panel.y) / 2));
            const bool finite = std::isfinite(point.x) && std::isfinite(point.y);
            if (wraps || !finite)
                flush();
            if (finite)
                line.push_back(point);
        }
        flush();
    }
}

/// Starts a block of data that `commands` draws in the given style, unless it stays empty.
void GnuplotScript::begin_block(Panel& panel, const char* name, const char* style) {
    block_ = fmt::format("${}_{}", panel.name, name);
    block_start_ = data_.size();
    block_style_ = style;
}

void GnuplotScript::end_block(Panel& panel) {
    if (data_.size() == block_start_)
        return;
    data_.insert(block_start_, block_ + " << end\n");
    data_ += "end\n";
    panel.plots.push_back(block_ + " with " + block_style_);
}

void GnuplotScript::write_point(PlanePoint point) {
    data_ += fmt::format("{} {}\n", number_text(point.x), number_text(point.y));
}

void GnuplotScript::write_data(Panel& panel) {
    const auto point = [&](double time, const std::vector<double>& values) {
        return PlanePoint{value(panel.x, time, values.data()), value(panel.y, time, values.data())};
    };
    begin_block(panel, "jumps", "lines linestyle 2");
    const double width = panel.x_axis.high - panel.x_axis.low, height = panel.y_axis.high - panel.y_axis.low;
    const bool cyclic = period(panel.x) > 0 || period(panel.y) > 0;
    for (const PlotRecorder::Jump& jump : recorder_->jumps()) {
        const PlanePoint before = point(jump.time, jump.before), after = point(jump.time, jump.after);
        if (!cyclic && std::hypot((after.x - before.x) / width, (after.y - before.y) / height) > invisible) {
            write_point(before);
            write_point(after);
            data_ += '\n';
        }
    }
    end_block(panel);
    begin_block(panel, "curve", "lines linestyle 1");
    write_curve(panel);
    end_block(panel);
    begin_block(panel, "contacts", "points linestyle 3");
    for (const PlotRecorder::Jump& jump : recorder_->jumps()) {
        if (!jump.marked)
            continue;
        const PlanePoint before = point(jump.time, jump.before), after = point(jump.time, jump.after);
        write_point(before);
        if (after.x != before.x || after.y != before.y)
            write_point(after);
    }
    end_block(panel);
    begin_block(panel, "sections", "points linestyle 4");
    for (const PlotRecorder::Point& passage : recorder_->passages())
        write_point(point(passage.time, passage.values));
    end_block(panel);
}

std::string GnuplotScript::commands(const Panel& panel) const {
    std::string text =
        fmt::format("\nset lmargin at screen {}\nset rmargin at screen {}\nset bmargin at screen {}\n"
                    "set tmargin at screen {}\n",
                    number_text(panel.left / width_), number_text((panel.left + panel.width) / width_),
                    number_text(panel.bottom / height_), number_text((panel.bottom + panel.height) / height_));
    text += fmt::format("set xrange [{}:{}]\nset xtics {}\n", number_text(panel.x_axis.low),
                        number_text(panel.x_axis.high), number_text(panel.x_axis.tic));
    text += fmt::format("set yrange [{}:{}]\nset ytics {}\n", number_text(panel.y_axis.low),
                        number_text(panel.y_axis.high), number_text(panel.y_axis.tic));
    text += panel.x_labels ? "set format x \"%g\"\n" : "set format x \"\"\n";
    text += fmt::format("set label 1 \"{}\" at screen {},{} center rotate by 90\n",
                        label(panel.y, panel.height + history_gap, true), number_text(panel.label / width_),
                        number_text((panel.bottom + panel.height / 2) / height_));
    text += panel.x_labels ? fmt::format("set xlabel \"{}\"\n", label(panel.x, panel.width, false)) : "unset xlabel\n";
    if (panel.x.is_time && recorder_->singularity())
        text += fmt::format("set arrow 1 from {0}, graph 0 to {0}, graph 1 nohead linestyle 2\n",
                            number_text(*recorder_->singularity()));
    else
        text += "unset arrow 1\n";
    text += panel.plots.empty() ? "plot NaN\n" : fmt::format("plot {}\n", fmt::join(panel.plots, ", "));
    return text;
}

std::string GnuplotScript::legend() const {
    std::string text;
    double x = panels_.front().left + 6;
    const double y = (height_ - top_margin / 2) / height_;
    const auto entry = [&](int index, const std::string& name, const char* mark) {
        text += fmt::format("set label {} \"{}\" at screen {},{} left point {} offset 0.8,0\n", index, plain(name),
                            number_text(x / width_), number_text(y), mark);
        x += 110;
    };
    if (has_marks_)
        entry(2, "contact", "linestyle 3");
    if (!recorder_->passages().empty())
        entry(3, recorder_->section_names(), "linestyle 4");
    return text;
}

std::string GnuplotScript::text(const std::string& ending, const std::string& output) const {
    std::string text = "# Drawn by gnuplot; to change the picture, change this file and run gnuplot on it.\n";
    const auto pixels = [&](double length) { return static_cast<int>(std::lround(unit_ * length)); };
    const std::string name = style_.font.empty() ? "Arial" : style_.font;
    if (ending == "svg")
        text += fmt::format("set terminal svg size {},{} enhanced font \"{},{:.4g}\" linewidth {:.4g} background "
                            "\"white\"\n",
                            pixels(width_), pixels(height_), name, 12 * unit_, unit_);
    else if (ending == "png")
        text += fmt::format("set terminal pngcairo size {},{} enhanced font \"{},{:.4g}\" fontscale 2 linewidth {:.4g} "
                            "pointscale 2\n",
                            pixels(2 * width_), pixels(2 * height_), name, 10 * unit_, 2 * unit_);
    else
        text +=
            fmt::format("set terminal {}cairo size {:.4f}in,{:.4f}in enhanced font \"{},{:.4g}\" linewidth {:.4g}\n",
                        ending, unit_ * width_ / 96, unit_ * height_ / 96, name, 9 * unit_, unit_);
    text += fmt::format("set output {}\n\n", quoted_path(output));
    text += data_;
    text += fmt::format("\nset style line 1 linecolor rgb \"{}\" linewidth 1.2\n", style_.grey ? "black" : "#1f4e8c");
    text += "set style line 2 linecolor rgb \"#808080\" linewidth 0.7 dashtype (4, 3)\n"
            "set style line 3 linecolor rgb \"black\" pointtype 7 pointsize 0.35\n"
            "set border linewidth 0.8\nset tics in scale 0.6\nunset key\n"
            "set format y \"%g\"\nset encoding utf8\nset minussign\nset multiplot\n";
    text += fmt::format("set style line 4 linecolor rgb \"{}\" pointtype 6 pointsize 0.8 linewidth 1.1\n",
                        style_.grey ? "#606060" : "#b22222");
    text += legend();
    for (std::size_t i = 0; i < panels_.size(); ++i) {
        text += commands(panels_[i]);
        if (i == 0)
            text += "unset label 2\nunset label 3\n";
    }
    return text + "unset multiplot\nunset output\n";
}

} // namespace graze
