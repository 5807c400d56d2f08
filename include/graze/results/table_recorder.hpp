#pragma once

#include "graze/results/quantity_evaluator.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Greatest number of rows in the table of samples; limits the memory it takes.
inline constexpr std::size_t most_samples = 10'000'000;
/// Greatest number of cells in any table, about 800 MB.
inline constexpr std::size_t most_cells = 50'000'000;

enum class TableKind { samples, contacts, sections, extrema, minima, derivatives, summary };

std::optional<TableKind> table_kind(std::string_view name);
std::vector<std::string> table_kind_names();

/// Fills one table while a trajectory is computed.
class TableRecorder : public Observer {
public:
    /// To be called when the shown part of the trajectory begins, with its duration if that is known.
    virtual void begin(const Trajectory&, std::optional<double>) {}
    /// To be called when the trajectory has ended.
    virtual void finish(const Trajectory&) {}
    /// False if rows had to be left out because the table was full.
    virtual bool is_complete() const { return true; }
    /// Whether the table has its greatest number of cells, so that the trajectory should end.
    bool is_full() const { return table_.rows() * table_.columns().size() >= most_cells_; }
    void hold_at_most(std::size_t cells) { most_cells_ = cells; }
    const Table& table() const { return table_; }

protected:
    Table table_;

private:
    std::size_t most_cells_ = most_cells;
};

/// Which table is filled, and its options.
struct TableRequest {
    TableKind kind = TableKind::samples;
    std::vector<NamedValue> quantities;         ///< further columns after the states
    std::vector<NamedValue> extrema;            ///< quantities whose extrema the probes detect
    std::size_t first_extremum = 0;             ///< index of the first extremum probe; the probes before are sections
    std::vector<bool> events;                   ///< for each event, whether its contacts are shown
    std::size_t samples = 500;                  ///< table of samples: number of rows, unless `every` is given
    std::optional<double> every;                ///< table of samples: time between rows
    std::size_t most_cells = graze::most_cells; ///< see TableRecorder::is_full
    std::vector<std::string> directions;        ///< derivatives: with respect to these states and parameters
};

/// Refuses a table of samples that could not hold its rows, TableRequest::every apart.
/// @param duration of the motion; none: it is not known, and nothing is refused
/// @param asked the option or argument that gives the time between rows, for the message. @throws InputError
void require_room_for_samples(const TableRequest& request, std::optional<double> duration, const char* asked);

std::unique_ptr<TableRecorder> make_table_recorder(const Simulation& simulation, const TableRequest& request);

} // namespace graze
