#include "graze/results/result_file.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/run_kind.hpp"
#include "results/file_form.hpp"
#include "results/point_columns.hpp"
#include "results/result_file_state.hpp"
#include "results/run_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t longest_failure = 4000; ///< bytes; the rest of the text is not shown

/// Checks the names in a run of an untrusted file, since they are shown in tables and pictures and used as file names.
void require_names(const RunRecord& run, const std::string& path) {
    const Place place{path, 0, 0};
    require_file_name(run.name, "name of a run", place);
    if (!run_kind(run.kind))
        throw InputError(place, fmt::format("run '{}' is of unknown kind '{}'", run.name, run.kind),
                         "use the version of graze that wrote it");
    // A family of orbits is followed along a quantity, in a model that may have no parameters.
    const bool may_be_family = run.kind == name_of(RunKind::follow);
    if (((run.is_swept() || run.is_followed()) && run.coordinates.empty() && !may_be_family) ||
        (!run.is_branch() && run.directions.empty()))
        throw_contradiction(path, fmt::format("run '{}' varies nothing", run.name));
    require_plain_line(run.model_name, "name of a model", place);
    require_plain_line(run.version, "version", place);
    for (const auto* columns : {&run.coordinates, &run.states, &run.values})
        for (const ResultColumn& column : *columns) {
            require_plain_line(column.name, "name of a column", place);
            require_plain_line(column.unit, "unit of a column", place);
        }
    for (const auto* names : {&run.samplings, &run.modes, &run.directions})
        for (const std::string& name : *names)
            require_plain_line(name, "name", place);
    for (const PointName& point : run.point_names)
        require_plain_line(point.label + point.name, "name of a point", place);
}

/// Which format a reader of a newer file has to know.
std::int64_t needed_reader(const Database& database) {
    Statement row = database.prepare("SELECT CAST(value AS INTEGER) FROM meta WHERE key = ?");
    row.bind(1, std::string_view(oldest_reader_key));
    return row.step() && row.integer(0) > 0 ? row.integer(0) : std::numeric_limits<std::int64_t>::max();
}

} // namespace

bool RunRecord::is_swept() const {
    const auto known = run_kind(kind);
    return known && graze::is_swept(*known);
}

bool RunRecord::is_branch() const {
    const auto known = run_kind(kind);
    return known && graze::is_branch(*known);
}

bool RunRecord::is_followed() const {
    const auto known = run_kind(kind);
    return known && graze::is_followed(*known);
}

namespace {

bool fits(const Model& model, const RunRecord& run) {
    const auto is_known = [&](const ResultColumn& column) {
        return model.find_independent_parameter(column.name) || (!run.is_branch() && model.find_state(column.name));
    };
    const bool states =
        std::equal(model.states.begin(), model.states.end(), run.states.begin(), run.states.end(),
                   [](const State& state, const ResultColumn& column) { return state.name == column.name; });
    // The modes of a branch are stored with its segments, and checked when these are read.
    const bool modes =
        run.is_branch() || std::equal(model.modes.begin(), model.modes.end(), run.modes.begin(), run.modes.end(),
                                      [](const Mode& mode, const std::string& name) { return mode.name == name; });
    return states && modes && std::all_of(run.coordinates.begin(), run.coordinates.end(), is_known);
}

} // namespace

Place stored_place(const std::string& file, const std::string& what) {
    return {file.empty() ? what : fmt::format("{}: {}", file, what), 0, 0};
}

Model stored_model(const RunRecord& run) {
    const Place place = stored_place(run.file, fmt::format("model of run '{}'", run.name));
    Model model = parse_model(run.model, place.file);
    if (!fits(model, run))
        throw InputError(place, fmt::format("the model stored for run '{}' is not the one of its columns", run.name),
                         "the result file has been changed: ask for another copy, or run the study again");
    return model;
}

std::string result_path(const std::string& file_or_folder) {
    std::error_code error;
    return std::filesystem::is_directory(file_or_folder, error)
               ? (std::filesystem::path(file_or_folder) / "results.sqlite").string()
               : file_or_folder;
}

namespace {

/// A zero byte would end the path for the system, and another file would be meant.
void require_path(const std::string& path) {
    if (path.find('\0') != std::string::npos)
        throw FileError(path, "the path has a zero byte in it", "give the path of a file");
}

} // namespace

ResultFile::ResultFile(const std::string& path, Access access) {
    require_path(path);
    if (path.empty() || path == ":memory:") // SQLite would not keep these databases
        throw InputError(fmt::format("'{}' names no file to keep results in", path), "give the path of a file");
    const bool writing = access == Access::write;
    std::error_code error;
    if (!writing && !std::filesystem::exists(path, error))
        throw FileError(path, "there is no such result file", "run a study, which makes one");
    state_ = std::make_shared<State>(path, writing);
    const Database& database = state_->database;
    database.execute("BEGIN"); // another process may just be writing these three for the first time
    const std::int64_t application = database.value("PRAGMA application_id");
    const std::int64_t format = database.value("PRAGMA user_version");
    const bool empty = database.value("SELECT count(*) FROM sqlite_master") == 0;
    database.execute("COMMIT");
    if (empty && !writing)
        throw InputError(Place{path, 0, 0}, "the result file is empty", "run the study first");
    if (!empty && application != result_application)
        throw InputError(Place{path, 0, 0}, "this is no result file of graze",
                         "give the results.sqlite of a study, or its folder");
    const bool newer = format > result_format;
    if (!empty && (format < oldest_result_format || (newer && needed_reader(database) > result_format)))
        throw InputError(Place{path, 0, 0},
                         fmt::format("the result file has format {}, this version of graze knows formats {} to {}",
                                     format, oldest_result_format, result_format),
                         "use the version of graze that wrote it, or run the study into another folder");
    if (newer && writing)
        throw InputError(Place{path, 0, 0},
                         fmt::format("the result file has format {}, which this version of graze reads, but does not "
                                     "write: it writes format {}",
                                     format, result_format),
                         "go on with the version of graze that wrote it, or run the study into another folder");
    if (!empty)
        state_->format = static_cast<int>(format);
    if (!writing) {
        if (format != result_format)
            state_->missing = show_in_this_form(database, runs());
        database.execute("PRAGMA cache_size = -65536; PRAGMA query_only = 1; "
                         "PRAGMA cell_size_check = 1");
        state_->database.only_read();
        state_->opened = true;
        return;
    }
    if (empty)
        database.execute("PRAGMA page_size = 8192");
    database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA cache_size = -32768; "
                     "PRAGMA wal_autocheckpoint = 4096");
    if (empty)
        state_->at_once([&] {
            database.execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; {}", result_application,
                                         result_format, common_tables()));
            database.execute(fmt::format("INSERT INTO meta VALUES('{}', '{}')", oldest_reader_key, oldest_reader));
        });
    else if (format < result_format)
        state_->at_once([&] {
            state_->missing = bring_into_this_form(database, runs());
            if (!state_->missing.empty()) {
                database.execute(fmt::format("PRAGMA user_version = {}", result_format));
                database.execute(
                    fmt::format("INSERT OR REPLACE INTO meta VALUES('{}', '{}')", oldest_reader_key, oldest_reader));
                state_->format = result_format;
            }
        });
    state_->opened = true;
}

std::optional<ResultFile> ResultFile::find(const std::string& path) {
    require_path(path);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        return std::nullopt;
    if (Database(path, false).value("SELECT count(*) FROM sqlite_master") == 0)
        return std::nullopt;
    return ResultFile(path, Access::read);
}

const std::vector<std::string>& ResultFile::missing() const {
    return state_->missing;
}

const std::string& ResultFile::path() const {
    return state_->database.path();
}

int ResultFile::format() const {
    return state_->format;
}

void ResultFile::set_patience(std::chrono::milliseconds patience) {
    state_->database.set_patience(patience);
}

void ResultFile::flush() {
    try {
        state_->commit();
    } catch (...) {
        state_->sqlite_rollback();
        throw;
    }
}

void ResultFile::copy_to(const std::string& path) {
    if (!state_->lock)
        throw InputError(Place{this->path(), 0, 0}, "a result file is not copied while it is open for reading only",
                         "open it for writing");
    require_path(path);
    flush();
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, error)))
        throw FileError(path, "the file is there already", "choose another name, or remove it first");
    state_->database.copy_to(path);
}

/// The runs that a statement selects after `SELECT ... FROM runs`. @param name bound to it; empty: nothing is
std::vector<RunRecord> ResultFile::read_runs(const std::string& which, const std::string& name) const {
    const Database& database = state_->database;
    std::vector<RunRecord> runs;
    Statement rows = database.prepare(fmt::format("SELECT {} FROM runs {}", listed(kinds_of(run_columns())), which));
    if (!name.empty())
        rows.bind(1, std::string_view(name));
    while (rows.step()) {
        RunRecord& run = runs.emplace_back();
        run.file = path();
        read_row(rows, run_columns(), NoContext{}, run, run);
        read_lists(database, run);
        if (run.status == RunStatus::failed)
            run.failure = shortened(printable_line(note(key_of_failure(run.name)).value_or("")), longest_failure);
        require_names(run, path());
    }
    return runs;
}

std::vector<RunRecord> ResultFile::runs() const {
    return read_runs("ORDER BY number", "");
}

std::optional<RunRecord> ResultFile::find_run(const std::string& name) const {
    if (name.empty())
        return std::nullopt;
    // Of the others nothing is read: the settings of one alone may have millions of numbers.
    std::vector<RunRecord> found = read_runs("WHERE name = ? ORDER BY number LIMIT 1", name);
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

void ResultFile::remove_run(const std::string& name) {
    const auto run = find_run(name);
    if (!run)
        return;
    state_->writers.clear();
    state_->at_once([&] {
        const Database& database = state_->database;
        const RunTables tables(*run);
        // The views refer to the tables, and are created again without them.
        database.execute(views({}));
        database.execute(fmt::format("DROP TABLE {}; DROP TABLE {}", tables.points, tables.samples));
        std::vector<std::string> shared{"columns", "names", "estimates", "covariances"};
        for (const DetailTable& table : detail_tables())
            shared.push_back(table.name);
        for (const std::string& table : shared)
            database.prepare(fmt::format("DELETE FROM {} WHERE run = ?", table)).run(name);
        database.prepare("DELETE FROM runs WHERE name = ?").run(name);
        database.prepare("DELETE FROM meta WHERE key = ?").run(key_of_failure(name));
        database.execute(views(runs()));
    });
}

void ResultFile::begin_run(const RunRecord& given) {
    RunRecord run = given;
    run.status = RunStatus::unfinished;
    run.failure.clear();
    require_names(run, path());
    require_free_name(run.name, run.is_branch(), names_of(runs()), Place{path(), 0, 0});
    remove_run(run.name);
    state_->at_once([&] {
        const Database& database = state_->database;
        database.execute(RunTables(run).create());
        const std::vector<ColumnKind> columns = kinds_of(run_columns());
        Statement insert = database.prepare(insert_into(fmt::format("runs({})", listed(columns)), columns.size()));
        write_row(insert, run_columns(), NoContext{}, run);
        write_lists(database, run);
        database.execute(views(runs()));
    });
}

void ResultFile::order_runs(const std::vector<std::string>& names) {
    const std::vector<std::string> present = names_of(runs());
    std::vector<std::string> ordered;
    for (const auto* list : {&names, &present})
        for (const std::string& name : *list)
            if (std::find(ordered.begin(), ordered.end(), name) == ordered.end() &&
                std::find(present.begin(), present.end(), name) != present.end())
                ordered.push_back(name);
    const auto last = state_->database.value("SELECT coalesce(max(number), 0) FROM runs");
    if (ordered == present && last == static_cast<std::int64_t>(present.size()))
        return;
    state_->at_once([&] {
        const Database& database = state_->database;
        // Renumbers through negative numbers, so that no number occurs twice.
        for (std::size_t i = 0; i < ordered.size(); ++i)
            database.prepare("UPDATE runs SET number = ? WHERE name = ?")
                .run(-static_cast<std::int64_t>(i + 1), ordered[i]);
        database.execute("UPDATE runs SET number = -number");
        database.execute(views(runs()));
    });
}

void ResultFile::name_points(const std::string& run, const std::vector<PointName>& names) {
    state_->at_once([&] { write_point_names(state_->database, run, names); });
}

void ResultFile::replace_model(const std::string& run, const std::string& model) {
    state_->at_once([&] { state_->database.prepare("UPDATE runs SET model = ? WHERE name = ?").run(model, run); });
}

void ResultFile::replace_settings(const std::string& run, const std::string& settings) {
    state_->at_once(
        [&] { state_->database.prepare("UPDATE runs SET settings = ? WHERE name = ?").run(settings, run); });
}

void ResultFile::set_note(const std::string& key, const std::string& text) {
    state_->at_once(
        [&] { state_->database.prepare("INSERT OR REPLACE INTO meta(key, value) VALUES(?,?)").run(key, text); });
}

std::optional<std::string> ResultFile::note(const std::string& key) const {
    Statement row = state_->database.prepare("SELECT value FROM meta WHERE key = ?");
    row.bind(1, std::string_view(key));
    return row.step() ? std::optional(row.text(0)) : std::nullopt;
}

void ResultFile::complete_run(const std::string& name) {
    state_->mark(name, RunStatus::complete, "");
}

void ResultFile::fail_run(const std::string& name, const std::string& failure) {
    state_->mark(name, RunStatus::failed, failure);
}

void ResultFile::reopen_run(const std::string& name) {
    state_->mark(name, RunStatus::unfinished, "");
}

} // namespace graze
