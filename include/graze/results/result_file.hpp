#pragma once

#include "graze/base/input_error.hpp"
#include "graze/identify/estimate.hpp"
#include "graze/results/orbit_record.hpp"
#include "graze/sweep/attractor.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Type of the cells of a column; a cell of any type may also be missing.
enum class ColumnType { whole, real, text };

/// A named column of numbers.
struct ResultColumn {
    std::string name, unit;
};

enum class RunStatus {
    unfinished,
    complete,
    failed, ///< stays incomplete until the study or a file that it reads is changed
};

/// The status as the file stores it: "unfinished", "complete" or "failed".
std::string_view name_of(RunStatus status);

/// A name that a study gives to a special point of a run in addition to its label.
struct PointName {
    std::string label, name;
};

/// Description of a run, without its points.
struct RunRecord {
    std::string name; ///< letters, digits, '.', '_' and '-'
    std::string kind; ///< simulate, sweep, basin, orbit, continue, curve, ladder, torus, record, identify,
                      ///< atlas
    std::string model_name;
    std::string model;       ///< complete text of the model file
    std::string settings;    ///< JSON object
    std::string fingerprint; ///< hash of everything that the numbers depend on
    std::string version;     ///< version of graze that made the run
    /// Quantities that vary from point to point: parameters and initial states. Runs with orbits have all parameters
    /// here, beginning with the one that is followed.
    std::vector<ResultColumn> coordinates;
    std::vector<ResultColumn> states;
    std::vector<ResultColumn> values; ///< quantities of samples, or monitors of orbits
    std::vector<std::string> samplings, modes, directions;
    std::size_t points = 0; ///< planned number of points
    RunStatus status = RunStatus::unfinished;
    std::string file = {};                   ///< path of the file from which the record was read
    std::string failure = {};                ///< why the run failed and what to do, as one line of printable characters
    std::vector<PointName> point_names = {}; ///< names that the study gives to special points

    /// See is_swept, is_branch and is_followed of RunKind.
    bool is_swept() const;
    bool is_branch() const;
    bool is_followed() const;
    /// The name of the point with this label, shown in place of the label; the label itself if the point has no name.
    const std::string& point_name(const std::string& label) const;
    /// The label of the point with this name; empty if there is none.
    std::string label_named(const std::string& shown) const;
};

/// A number estimated from measurements, as a result file stores it.
struct EstimateRecord {
    std::string name; ///< the name of the parameter, if the number is one
    std::string unit;
    Estimate estimate{}; ///< the error is unknown if there are no degrees of freedom
    std::string note{};  ///< for example "at its bound"; empty: none
};

/// The estimates of one run of kind `identify`.
struct EstimateRecords {
    std::vector<EstimateRecord> numbers{};
    /// Covariance matrix of the numbers, row by row; 0 where a covariance is unknown. Empty: all are unknown.
    std::vector<double> covariance{};
};

/// Path of the result file in the folder of a study; a path of a file is returned unchanged.
std::string result_path(const std::string& file_or_folder);

/// Place of a text stored in a result file, for messages: "file: what".
Place stored_place(const std::string& file, const std::string& what);

/// The model of a run. @throws InputError if it cannot be read, or does not fit the columns of the run
Model stored_model(const RunRecord& run);

/// One point of a run and its result.
struct PointRecord {
    std::size_t number = 0, chain = 0, direction = 0; ///< direction: index in RunRecord::directions
    std::vector<double> coordinates;
    PointResult result;
};

/// The results of a study in one SQLite file (docs/result-file.md). One process can write while others read. Points are
/// written in transactions: if the process is killed, the points of the last fraction of a second are lost, and every
/// stored point is complete. Copies are handles of the same open file, which is closed with the last of them.
class ResultFile {
public:
    enum class Access { read, write };
    /// Opens a file; with Access::write a missing file is created.
    /// Files of older versions are read and continued; what they lack is `missing`, and read as absent. Files of newer
    /// versions are read if these have only added something.
    /// @throws InputError if it is no result file, has an incompatible format, cannot be opened, or another
    ///         process writes to it, and for the paths "" and ":memory:", which SQLite would not keep as files
    ResultFile(const std::string& path, Access access);

    /// The file, for reading; nothing where there is none, or where a writer has created it and written nothing yet.
    /// @throws InputError as the constructor does
    static std::optional<ResultFile> find(const std::string& path);

    /// All runs, in the order of their numbers. @throws InputError if the contents of the file contradict each other
    std::vector<RunRecord> runs() const;
    std::optional<RunRecord> find_run(const std::string& name) const;
    /// Begins a run, and removes an earlier one with the same name. @throws InputError if it cannot be written
    void begin_run(const RunRecord& run);
    /// Puts the named runs first, in the order of the names; the other runs keep their order.
    void order_runs(const std::vector<std::string>& names);
    /// Replaces the names of the special points of a run.
    void name_points(const std::string& run, const std::vector<PointName>& names);
    /// Replaces the text of a run's model by one of the same equations, with another drawing.
    void replace_model(const std::string& run, const std::string& model);
    /// Replaces the settings of a run by others that lead to the same points.
    void replace_settings(const std::string& run, const std::string& settings);
    /// Removes a run with its points and all other rows.
    void remove_run(const std::string& name);
    /// Adds a point to a run. It is committed when a later point is added, after 50 ms at the earliest, or by `flush`.
    void add_point(const std::string& run, const PointRecord& point);
    /// Changes the label of points of a run, and the detail that gives the reason of the label.
    void set_label(const std::string& run, const std::vector<std::size_t>& points, Label label,
                   const std::string& detail);
    /// Adds an orbit to a run of kind orbit or continue.
    void add_orbit(const std::string& run, const OrbitRecord& orbit);
    /// Stores the estimates of a run of kind identify, in place of earlier ones.
    void set_estimates(const std::string& run, const EstimateRecords& found);
    /// The estimates of a run; empty for runs of other kinds.
    EstimateRecords estimates(const std::string& run) const;
    /// Commits all points that have been added.
    void flush();
    /// Writes all that is there to another file, which must not exist. @throws InputError when it cannot be written, of
    /// which nothing is left then, and when this file is open for reading only
    void copy_to(const std::string& path);
    /// Marks a run as complete.
    void complete_run(const std::string& run);
    /// Marks a run as failed; its points stay. @param failure why it failed and what to do
    void fail_run(const std::string& run, const std::string& failure);
    /// Marks a run as unfinished, so that it can be continued.
    void reopen_run(const std::string& run);

    /// Stores a text that belongs to no run under a key, in place of an earlier one.
    void set_note(const std::string& key, const std::string& text);
    std::optional<std::string> note(const std::string& key) const;

    /// Number of points that a run has so far.
    std::size_t point_count(const std::string& run) const;
    /// The last point of each chain (number / chain_length) that has points, without samples, in order: see `points`.
    std::function<std::optional<PointRecord>()> last_points(const std::string& run, std::size_t chain_length) const;
    /// The numbers of the points that a run has, in order, without those in a mode that it does not know: see `points`.
    std::function<std::optional<std::size_t>()> point_numbers(const std::string& run) const;
    /// One point with its samples.
    std::optional<PointRecord> point(const std::string& run, std::size_t number) const;
    /// Gives all points of a run with their samples to a function, one by one in the order of their numbers.
    void each_point(const std::string& run, const std::function<void(const PointRecord& point)>& use) const;
    /// The same, but each call of the function that is returned reads the next point; after the last there is none. It
    /// may outlive this handle of the file.
    std::function<std::optional<PointRecord>()> points(const std::string& run) const;
    /// The point of a run whose coordinate is nearest to a value, among points of one direction or of all.
    std::optional<PointRecord> nearest_point(const std::string& run, const std::string& coordinate, double value,
                                             std::optional<std::size_t> direction) const;

    /// The orbits of a run of kind orbit or continue, by number. @param special whether regular points are left out
    std::vector<OrbitRecord> orbits(const std::string& run, bool special) const;
    /// The orbit with this number.
    std::optional<OrbitRecord> orbit(const std::string& run, std::size_t number) const;
    /// The orbit with this label, for example "GR1".
    std::optional<OrbitRecord> orbit(const std::string& run, const std::string& label) const;

    /// Rows of a query, read one after the other. Each cell is a number, a text, or missing. Rows may
    /// outlive the file.
    class Rows {
    public:
        bool next();
        std::size_t columns() const;
        std::string column_name(std::size_t column) const;
        bool is_null(std::size_t column) const;
        bool is_text(std::size_t column) const;
        bool is_integer(std::size_t column) const;
        double number(std::size_t column) const; ///< 0 if it is missing @throws InputError for a text
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
    /// Runs a query. Safe for queries and files from untrusted sources: a query can only read, and is interrupted after
    /// 30 s (and one more second for each MB of the file).
    /// @param sql one SELECT; @param values bound to its parameters ?1, ?2, ...
    /// @throws InputError if it is no valid SELECT
    Rows query(const std::string& sql, const std::vector<double>& values = {}) const;

    /// Sets the time that one query may take.
    void set_patience(std::chrono::milliseconds patience);

    const std::string& path() const;
    /// What a file of another version lacks of what this version writes: "run.column", or the name of a table.
    const std::vector<std::string>& missing() const;
    /// Number of the format of the file.
    int format() const;

private:
    struct State;
    std::vector<RunRecord> read_runs(const std::string& which, const std::string& name) const;
    std::vector<OrbitRecord> read_orbits(const std::string& run, const std::string& where, double number,
                                         const std::string& label) const;
    std::shared_ptr<State> state_;
};

} // namespace graze
