#pragma once

#include "picture/curve.hpp"
#include "program/plot_recorder.hpp"

#include <string>
#include <vector>

namespace graze {

/// A picture in the language of gnuplot, data included.
class GnuplotScript {
public:
    /// @param style its width and height are those of the whole picture; 0: as large as it takes
    explicit GnuplotScript(const PlotRecorder& recorder, const FigureStyle& style = {});

    /// @param ending svg, png, pdf or eps
    /// @param output the file that the commands write
    std::string text(const std::string& ending, const std::string& output) const;

private:
    /// One coordinate of a panel.
    struct Coordinate {
        bool is_time = false;
        std::size_t column = 0;
    };
    struct Panel {
        Coordinate x, y;
        Axis x_axis, y_axis;
        std::string name;                                   ///< of its data blocks
        double left = 0, bottom = 0, width = 0, height = 0; ///< in pixels
        double label = 0;                                   ///< where the label of the y axis is centred
        bool x_labels = true;
        std::vector<std::string> plots; ///< parts of its plot command
    };

    void make_panels();
    /// Of histories that nobody asked for, those in which something changes, if there are any.
    std::vector<std::size_t> shown_histories() const;
    bool changes(std::size_t column) const;
    void place_panels();
    void place_rows();
    void place_columns();
    /// Makes the panels wider or less so, until the picture is as wide as was asked for.
    void fit_width(double asked);
    double place_column(double start, bool over_time);
    Axis axis_of(const Coordinate& coordinate, int tics, double margin) const;
    double period(const Coordinate& coordinate) const {
        return coordinate.is_time ? 0 : recorder_->period(coordinate.column);
    }
    double value(const Coordinate& coordinate, double time, const double* values) const {
        return coordinate.is_time ? time : values[coordinate.column];
    }
    void choose_labels();
    /// In enhanced text for double quotes; empty when it should be in words but does not fit.
    std::string label(const Coordinate& coordinate, double room, bool two_lines) const;
    void write_data(Panel& panel);
    void write_curve(const Panel& panel);
    void write_point(PlanePoint point);
    void begin_block(Panel& panel, const char* name, const char* style);
    void end_block(Panel& panel);
    std::string commands(const Panel& panel) const;
    std::string legend() const;

    const PlotRecorder* recorder_;
    FigureStyle style_;
    double unit_ = 1;                           ///< pixels at 96 per inch of a length of the layout
    double asked_width_ = 0, asked_height_ = 0; ///< in lengths of the layout; 0: any
    double stretch_ = 1;                        ///< of the panels' usual widths
    bool stacked_ = false;                      ///< portraits stand below histories
    std::vector<Panel> panels_;
    double width_ = 0, height_ = 0;
    bool long_labels_ = false;
    bool has_marks_ = false;
    std::string data_, block_, block_style_;
    std::size_t block_start_ = 0;
};

} // namespace graze
