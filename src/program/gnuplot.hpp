#pragma once

#include "program/curve.hpp"
#include "program/plot_recorder.hpp"

#include <string>
#include <vector>

namespace graze {

/// A picture in the language of gnuplot, data included.
class GnuplotScript {
public:
    explicit GnuplotScript(const PlotRecorder& recorder);

    /// @param ending svg, png or pdf
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
    void place_panels();
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
    std::vector<Panel> panels_;
    double width_ = 0, height_ = 0;
    bool long_labels_ = false;
    bool has_marks_ = false;
    std::string data_, block_, block_style_;
    std::size_t block_start_ = 0;
};

} // namespace graze
