#pragma once

#include "graze/base/input_error.hpp"
#include "graze/results/estimate_record.hpp"
#include "graze/results/orbit_record.hpp"
#include "graze/sweep/attractor.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What the cells of a column are, where they are not missing.
enum class ColumnType { whole, real, text };

/// A named column of numbers.
struct ResultColumn {
    std::string name, unit;
};

enum class RunStatus {
    unfinished,
    complete,
    failed, ///< it will not become complete unless the study changes, or what it reads
};

/// As in the file: "unfinished", "complete" or "failed".
std::string_view name_of(RunStatus status);

/// What a study calls a special point of a run besides its label.
struct PointName {
    std::string label, name;
};

/// What is known of a run besides its points.
struct RunRecord {
    std::string name; ///< letters, digits, '.', '_' and '-'
    std::string kind; ///< simulate, sweep, basin, orbit, continue, curve, ladder, record, identify
    std::string model_name;
    std::string model;       ///< text of the model file, whole, as run
    std::string settings;    ///< JSON object
    std::string fingerprint; ///< changes when anything does that the numbers depend on
    std::string version;     ///< of graze
    /// What varies from point to point: parameters, initial states. Of orbits all parameters, first the one that is
    /// followed.
    std::vector<ResultColumn> coordinates;
    std::vector<ResultColumn> states;
    std::vector<ResultColumn> values; ///< of samples; of orbits the monitors
    std::vector<std::string> samplings, modes, directions;
    std::size_t points = 0; ///< planned
    RunStatus status = RunStatus::unfinished;
    std::string file = {};    ///< from which it was read
    std::string failure = {}; ///< why it failed, and what to do; on one line, without what controls a terminal
    std::vector<PointName> point_names = {}; ///< of its special points, as the study calls them

    /// As of the kind of this name.
    bool is_branch() const;
    bool is_followed() const;
    /// What people are shown in the place of a label: the point's name, if it has one.
    const std::string& point_name(const std::string& label) const;
    /// The label of the point with this name; empty: none has it.
    std::string label_named(const std::string& shown) const;
};

/// The result file of a study's folder, or the file itself.
std::string result_path(const std::string& file_or_folder);

/// The place of a text that a result file keeps, for messages: "file: what".
Place stored_place(const std::string& file, const std::string& what);

/// The model with which a run was made. @throws InputError when it cannot be read, or is not that of the run's columns
Model stored_model(const RunRecord& run);

/// One point with what was found there.
struct PointRecord {
    std::size_t number = 0, chain = 0, direction = 0; ///< direction: index in RunRecord::directions
    std::vector<double> coordinates;
    PointResult result;
};

/// The results of a study in one SQLite file (docs/result-file.md). One process writes, any number read meanwhile.
/// Points are written in transactions: after a kill, those of the last moments are missing, and no point is there in
/// part. Copies are handles of the same open file, which is closed with the last of them.
class ResultFile {
public:
    enum class Access { read, write };
    /// Opens the file; to write, makes it if there is none.
    /// Files of older versions are read and gone on with; what they lack is `missing`, and read as absent. Those of
    /// newer ones are read where these have only added something.
    /// @throws InputError when it is no such file, comes from a version too different, cannot be opened, or another
    /// process
    ///         writes to it. Results are kept in a file only: an empty name and ":memory:" are none
    ResultFile(const std::string& path, Access access);

    /// All runs, in the order in which they were begun. @throws InputError when the file contradicts itself
    std::vector<RunRecord> runs() const;
    std::optional<RunRecord> find_run(const std::string& name) const;
    /// Begins a run: replaces the one of that name. @throws InputError when it cannot be written
    void begin_run(const RunRecord& run);
    /// Orders runs as these names are; others come behind them, in the order in which they are.
    void order_runs(const std::vector<std::string>& names);
    /// Gives special points of a run other names, which change none of its numbers.
    void name_points(const std::string& run, const std::vector<PointName>& names);
    /// Removes a run with all that belongs to it.
    void remove_run(const std::string& name);
    /// Adds a point to a run. Written for good within a second, or by `flush`.
    void add_point(const std::string& run, const PointRecord& point);
    /// Gives points of a run another label, with the reason, once more is known than each tells by itself.
    void set_label(const std::string& run, const std::vector<std::size_t>& points, Label label,
                   const std::string& detail);
    /// Adds an orbit to a run of kind orbit or continue.
    void add_orbit(const std::string& run, const OrbitRecord& orbit);
    /// Keeps what a run of kind identify has found, in the place of what it had found.
    void set_estimates(const std::string& run, const EstimateRecords& found);
    /// What it has found; nothing of other runs.
    EstimateRecords estimates(const std::string& run) const;
    void flush();
    /// Marks a run as complete.
    void complete_run(const std::string& run);
    /// Marks a run as failed, with what it has. @param failure why, and what to do
    void fail_run(const std::string& run, const std::string& failure);
    /// Marks a run as unfinished, for it to be gone on with.
    void reopen_run(const std::string& run);

    /// Keeps a text that belongs to no run, in place of one with the same key.
    void set_note(const std::string& key, const std::string& text);
    std::optional<std::string> note(const std::string& key) const;

    /// How many points of a run are there.
    std::size_t point_count(const std::string& run) const;
    /// The last point of each chain (by number / chain_length), without samples; those without any are left out.
    std::vector<PointRecord> last_points(const std::string& run, std::size_t chain_length) const;
    /// One point with its samples.
    std::optional<PointRecord> point(const std::string& run, std::size_t number) const;
    /// The point of a run whose coordinate is nearest to a value, among those of one direction (or all).
    std::optional<PointRecord> nearest_point(const std::string& run, const std::string& coordinate, double value,
                                             std::optional<std::size_t> direction) const;

    /// The orbits of a run of kind orbit or continue, in their order. @param special only those where something happens
    std::vector<OrbitRecord> orbits(const std::string& run, bool special) const;
    /// One of them, by its number.
    std::optional<OrbitRecord> orbit(const std::string& run, std::size_t number) const;
    /// One of them, by its label, such as "GR1".
    std::optional<OrbitRecord> orbit(const std::string& run, const std::string& label) const;

    /// Rows of a query, for pictures, exports and tables: numbers, texts, or nothing. They may outlive the file.
    class Rows {
    public:
        bool next();
        std::size_t columns() const;
        std::string column_name(std::size_t column) const;
        bool is_null(std::size_t column) const;
        bool is_text(std::size_t column) const;
        bool is_integer(std::size_t column) const;
        double number(std::size_t column) const;
        std::int64_t integer(std::size_t column) const;
        std::string text(std::size_t column) const;
        ~Rows();
        Rows(Rows&&) noexcept;

    private:
        friend class ResultFile;
        struct State;
        explicit Rows(std::unique_ptr<State> state);
        std::unique_ptr<State> state_;
    };
    /// Safe for queries and files of strangers: it reads and nothing else, and is broken off after half a minute (and a
    /// second more for each MB of the file).
    /// @param sql one SELECT; @param values bound to its parameters ?1, ?2, ...
    /// @throws InputError when it is no such thing
    Rows query(const std::string& sql, const std::vector<double>& values = {}) const;

    /// How long one query may take, instead of that.
    void set_patience(std::chrono::milliseconds patience);

    const std::string& path() const;
    /// What a file of another version does not have of what this one writes: "run.column", or the name of a table.
    const std::vector<std::string>& missing() const;
    /// Number of the format in which it is written.
    int format() const;

private:
    struct State;
    std::vector<OrbitRecord> read_orbits(const std::string& run, const std::string& where, double number,
                                         const std::string& label) const;
    std::shared_ptr<State> state_;
};

} // namespace graze
