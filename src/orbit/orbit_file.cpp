#include "graze/orbit/orbit_file.hpp"

#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/base/text_file.hpp"
#include "graze/base/trimmed.hpp"
#include "graze/model/named_value.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace graze {

namespace {

struct Cell {
    std::string text;
    int column = 1; ///< column of the line where the cell begins, for messages
};

constexpr std::string_view blanks_and_quotes = " \t\r\"";

std::vector<Cell> cells_of(const std::string& line) {
    std::vector<Cell> cells;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.size(); ++i)
        if (i == line.size() || line[i] == ',') {
            cells.push_back({std::string(trimmed(std::string_view(line).substr(begin, i - begin), blanks_and_quotes)),
                             static_cast<int>(begin) + 1});
            begin = i + 1;
        }
    return cells;
}

/// Reads the table row by row.
class OrbitTable {
public:
    OrbitTable(const Model& model, const std::string& file) : model_(&model), file_(file) {}

    void heading(const std::vector<Cell>& cells, int line) {
        const auto place_of = [&](const std::string& name) -> std::optional<std::size_t> {
            for (std::size_t c = 0; c < cells.size(); ++c)
                if (cells[c].text == name)
                    return c;
            return std::nullopt;
        };
        const auto required = [&](const std::string& name) {
            const auto place = place_of(name);
            if (!place)
                fail(line, 1, fmt::format("there is no column '{}'", name),
                     "give columns segment, t and one for each state");
            return *place;
        };
        segment_ = required("segment");
        time_ = required("t");
        for (const State& state : model_->states)
            states_.push_back(required(state.name));
        end_ = place_of("end");
        mode_ = place_of("mode");
        width_ = cells.size();
        for (const Cell& cell : cells)
            check_name(cells, cell, line);
    }

    void row(const std::vector<Cell>& cells, int line) {
        if (cells.size() != width_)
            fail(line, 1, fmt::format("there are {} cells under {} names", cells.size(), width_),
                 "give every row as many cells as the first line");
        const double number = number_of(cells[segment_], line), time = number_of(cells[time_], line);
        const bool next = orbit_.starts.empty() || number != current_;
        if (next && number != static_cast<double>(orbit_.starts.size() + 1))
            fail(line, cells[segment_].column, fmt::format("segment {} follows {}", number, orbit_.starts.size()),
                 "number segments 1, 2, ... in the order of time");
        current_ = number;
        if (next) {
            std::vector<double>& start = orbit_.starts.emplace_back();
            for (const std::size_t column : states_)
                start.push_back(number_of(cells[column], line));
            orbit_.durations.push_back(0);
            begun_ = time;
            if (end_)
                ends_ += fmt::format("{}{} ", mode_ ? cells[*mode_].text + ":" : "", cells[*end_].text);
        }
        if (time - begun_ < orbit_.durations.back())
            fail(line, cells[time_].column, fmt::format("time goes back to {}", time), "let it rise within a segment");
        orbit_.durations.back() = time - begun_;
    }

    Orbit finish(std::string_view signature) {
        if (orbit_.starts.empty())
            fail(1, 1, "the table has no rows", "give a first and a last row for each segment");
        if (signature.empty() && !end_)
            fail(1, 1, "the ends of the segments are not given", "give a signature, or a column 'end'");
        orbit_.parameters = model_->parameter_values();
        orbit_.signature = parse_signature(*model_, signature.empty() ? ends_ : std::string(signature), {file_, 1, 1});
        if (orbit_.signature.size() != orbit_.starts.size())
            fail(1, 1,
                 fmt::format("the signature has {} segments and the table {}", orbit_.signature.size(),
                             orbit_.starts.size()),
                 "give rows for each segment of the signature");
        validate_orbit(*model_, orbit_);
        return orbit_;
    }

    [[noreturn]] void fail(int line, int column, const std::string& problem, const std::string& remedy) const {
        throw InputError(Place{file_, line, column}, problem, remedy);
    }

private:
    /// Refuses unknown column names. Other columns may hold any quantity that can be computed along the motion.
    void check_name(const std::vector<Cell>& cells, const Cell& cell, int line) const {
        if (std::ranges::count_if(cells, [&](const Cell& one) { return one.text == cell.text; }) > 1)
            fail(line, cell.column, fmt::format("there are two columns '{}'", cell.text), "leave one of them out");
        std::vector<std::string> known{"segment", "t", "end", "mode"};
        for (const State& state : model_->states)
            known.push_back(state.name);
        if (std::ranges::find(known, cell.text) != known.end())
            return;
        try {
            named_value(*model_, cell.text, {file_, line, cell.column});
        } catch (const InputError&) { // the name is not a quantity either
            const std::string nearest = nearest_name(cell.text, known);
            fail(line, cell.column, fmt::format("there is a column '{}', which means nothing", cell.text),
                 nearest.empty() ? "leave it out" : fmt::format("did you mean '{}'?", nearest));
        }
    }
    double number_of(const Cell& cell, int line) const {
        double value = 0;
        if (!read_whole(cell.text, value) || !std::isfinite(value))
            fail(line, cell.column, fmt::format("'{}' is not a number", cell.text), "give a finite number");
        return value;
    }

    const Model* model_;
    std::string file_;
    Orbit orbit_;
    std::size_t segment_ = 0, time_ = 0, width_ = 0;
    std::optional<std::size_t> end_, mode_;
    std::vector<std::size_t> states_;
    std::string ends_;
    double current_ = 0, begun_ = 0;
};

} // namespace

Orbit parse_orbit_table(const Model& model, std::string_view text, std::string_view signature,
                        const std::string& file) {
    OrbitTable table(model, file);
    std::istringstream lines{std::string(text)};
    std::string line;
    bool headed = false;
    for (int number = 1; std::getline(lines, line); ++number) {
        if (trimmed(line, blanks_and_quotes).empty() || line.front() == '#')
            continue;
        const std::vector<Cell> cells = cells_of(line);
        headed ? table.row(cells, number) : table.heading(cells, number);
        headed = true;
    }
    if (!headed)
        table.fail(1, 1, "the table is empty", "give a line of names and rows");
    return table.finish(signature);
}

Orbit read_orbit_table(const Model& model, const std::string& path, std::string_view signature) {
    return parse_orbit_table(model, read_text_file(path, "table of an orbit", longest_table), signature, path);
}

} // namespace graze
