#pragma once

#include "graze/results/state_columns.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Of the table of samples; more would fill the memory.
inline constexpr std::size_t most_samples = 10'000'000;
/// Of any table: some 800 MB.
inline constexpr std::size_t most_cells = 50'000'000;

enum class TableKind { samples, contacts, sections, extrema, minima, derivatives, summary };

std::optional<TableKind> table_kind(std::string_view name);
std::vector<std::string> table_kind_names();

/// Fills one table while a trajectory runs.
class TableRecorder : public Observer {
public:
    /// The leg to be shown begins.
    /// @param duration of it, if known
    virtual void begin(const Trajectory&, std::optional<double>) {}
    /// The trajectory has ended.
    virtual void finish(const Trajectory&) {}
    /// False when there was more to show than fits.
    virtual bool is_complete() const { return true; }
    /// No more fits into memory: the run is to end.
    bool is_full() const { return table_.rows() * table_.columns().size() >= most_cells_; }
    void hold_at_most(std::size_t cells) { most_cells_ = cells; }
    const Table& table() const { return table_; }

protected:
    Table table_;

private:
    std::size_t most_cells_ = most_cells;
};

/// What tables are made from.
struct TableRequest {
    TableKind kind = TableKind::samples;
    std::vector<NamedValue> quantities;
    std::vector<NamedValue> extrema; ///< of the extremum probes
    std::size_t first_extremum = 0;  ///< probes before it are sections
    std::vector<bool> events;        ///< which ones' contacts are shown
    std::size_t samples = 500;
    std::optional<double> every; ///< distance of samples, instead of their number
    std::size_t most_cells = graze::most_cells;
    std::vector<std::string> directions; ///< of derivatives: names of states and independent parameters
};

std::unique_ptr<TableRecorder> make_table_recorder(const Simulation& simulation, const TableRequest& request);

} // namespace graze
