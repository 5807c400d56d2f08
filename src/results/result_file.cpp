#include "graze/results/result_file.hpp"

#include "graze/symbolic/file_name.hpp"
#include "graze/symbolic/require.hpp"
#include "results/point_rows.hpp"
#include "results/result_file_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

namespace graze {

namespace {

/// Samples of a point follow one another from this many times its number on.
constexpr std::int64_t samples_of_a_point = std::int64_t{1} << 24;

std::string text_of(RunStatus status) {
    return status == RunStatus::complete ? "complete" : "unfinished";
}

/// Names from a file end up in tables, pictures and file names, whoever has written it.
void require_names(const RunRecord& run, const std::string& path) {
    const Place place{path, 0, 0};
    require_file_name(run.name, "name of a run", place);
    const std::array<std::string_view, 5> kinds{"simulate", "sweep", "basin", "orbit", "continue"};
    if (std::find(kinds.begin(), kinds.end(), run.kind) == kinds.end())
        throw InputError(place, fmt::format("run '{}' is of unknown kind '{}'", run.name, run.kind),
                         "use the version of graze that wrote it");
    if ((run.kind == "sweep" && run.coordinates.empty()) || (!run.is_branch() && run.directions.empty()))
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
}

} // namespace

ResultFile::ResultFile(const std::string& path, Access access) {
    const bool writing = access == Access::write;
    if (!writing && !std::filesystem::exists(path))
        throw InputError(Place{path, 0, 0}, "there is no such result file",
                         "graze run STUDY makes one, in the folder that --output names");
    auto lock = writing ? std::make_unique<WriteLock>(path) : nullptr;
    state_ = std::make_unique<State>(State{std::move(lock), Database(path, writing), false, {}, nullptr});
    const Database& database = state_->database;
    const std::int64_t application = database.value("PRAGMA application_id");
    const std::int64_t format = database.value("PRAGMA user_version");
    const bool empty = database.value("SELECT count(*) FROM sqlite_master") == 0;
    if (empty && !writing)
        throw InputError(Place{path, 0, 0}, "the result file is empty", "run the study first");
    if (!empty && application != result_application)
        throw InputError(Place{path, 0, 0}, "this is no result file of graze",
                         "give the results.sqlite of a study, or its folder");
    if (!empty && format != result_format)
        throw InputError(
            Place{path, 0, 0},
            fmt::format("the result file has format {}, this version of graze knows format {}", format, result_format),
            "use the version of graze that wrote it, or run the study into another folder");
    if (!writing) {
        database.execute("PRAGMA cache_size = -65536; PRAGMA query_only = 1; "
                         "PRAGMA cell_size_check = 1");
        state_->database.only_read();
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
        });
}

ResultFile::~ResultFile() {
    if (!state_)
        return;
    try {
        flush();
        state_->writer.reset();
        // One plain file, which can be read where nothing can be written; not while somebody reads it.
        if (state_->lock)
            state_->database.execute("PRAGMA journal_mode = DELETE");
    } catch (...) { // whoever wants to know has called flush
        state_->sqlite_rollback();
    }
    state_->writer.reset();
}

const std::string& ResultFile::path() const {
    return state_->database.path();
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

std::vector<RunRecord> ResultFile::runs() const {
    const Database& database = state_->database;
    std::vector<RunRecord> runs;
    Statement rows = database.prepare("SELECT name, kind, status, points, model_name, model, settings, fingerprint, "
                                      "version FROM runs ORDER BY number");
    while (rows.step()) {
        RunRecord run;
        run.name = rows.text(0);
        run.kind = rows.text(1);
        run.status = rows.text(2) == "complete" ? RunStatus::complete : RunStatus::unfinished;
        run.points = static_cast<std::size_t>(rows.integer(3));
        run.model_name = rows.text(4);
        run.model = rows.text(5);
        run.settings = rows.text(6);
        run.fingerprint = rows.text(7);
        run.version = rows.text(8);
        Statement columns = database.prepare("SELECT place, name, unit FROM columns WHERE run = ? ORDER BY position");
        columns.bind(1, std::string_view(run.name));
        while (columns.step()) {
            const std::string place = columns.text(0);
            auto& list = place == "coordinate" ? run.coordinates : place == "state" ? run.states : run.values;
            list.push_back({columns.text(1), columns.text(2)});
        }
        Statement names = database.prepare("SELECT what, name FROM names WHERE run = ? ORDER BY position");
        names.bind(1, std::string_view(run.name));
        while (names.step()) {
            const std::string what = names.text(0);
            (what == "sampling" ? run.samplings : what == "mode" ? run.modes : run.directions).push_back(names.text(1));
        }
        require_names(run, path());
        runs.push_back(std::move(run));
    }
    return runs;
}

std::optional<RunRecord> ResultFile::find_run(const std::string& name) const {
    for (RunRecord& run : runs())
        if (run.name == name)
            return std::move(run);
    return std::nullopt;
}

void ResultFile::remove_run(const std::string& name) {
    const auto run = find_run(name);
    if (!run)
        return;
    state_->writer.reset();
    state_->at_once([&] {
        const Database& database = state_->database;
        const RunTables tables(*run);
        // The views name the tables, and are made anew without them.
        database.execute(views({}));
        database.execute(fmt::format("DROP TABLE {}; DROP TABLE {}", tables.points, tables.samples));
        std::vector<std::string> shared = tables_of_details();
        shared.insert(shared.end(), {"columns", "names"});
        for (const std::string& table : shared)
            database.prepare(fmt::format("DELETE FROM {} WHERE run = ?", table)).bind(1, std::string_view(name)).run();
        database.prepare("DELETE FROM runs WHERE name = ?").bind(1, std::string_view(name)).run();
        database.execute(views(runs()));
    });
}

void ResultFile::begin_run(const RunRecord& run) {
    require_names(run, path());
    remove_run(run.name);
    state_->at_once([&] {
        const Database& database = state_->database;
        const RunTables tables(run);
        database.execute(tables.create());
        database
            .prepare("INSERT INTO runs(name, kind, status, points, model_name, model, settings, fingerprint, version) "
                     "VALUES(?,?,?,?,?,?,?,?,?)")
            .bind(1, std::string_view(run.name))
            .bind(2, std::string_view(run.kind))
            .bind(3, std::string_view("unfinished"))
            .bind(4, run.points)
            .bind(5, std::string_view(run.model_name))
            .bind(6, std::string_view(run.model))
            .bind(7, std::string_view(run.settings))
            .bind(8, std::string_view(run.fingerprint))
            .bind(9, std::string_view(run.version))
            .run();
        Statement column = database.prepare("INSERT INTO columns VALUES(?,?,?,?,?,?)");
        const auto add = [&](std::string_view place, const std::vector<ResultColumn>& list,
                             const std::vector<std::string>& names) {
            for (std::size_t i = 0; i < list.size(); ++i)
                column.bind(1, std::string_view(run.name))
                    .bind(2, place)
                    .bind(3, i)
                    .bind(4, std::string_view(list[i].name))
                    .bind(5, std::string_view(list[i].unit))
                    .bind(6, std::string_view(names[i]))
                    .run();
        };
        add("coordinate", run.coordinates, tables.coordinates);
        add("state", run.states, tables.states);
        add("value", run.values, tables.values);
        Statement name = database.prepare("INSERT INTO names VALUES(?,?,?,?)");
        const auto add_names = [&](std::string_view what, const std::vector<std::string>& list) {
            for (std::size_t i = 0; i < list.size(); ++i)
                name.bind(1, std::string_view(run.name))
                    .bind(2, what)
                    .bind(3, i)
                    .bind(4, std::string_view(list[i]))
                    .run();
        };
        add_names("sampling", run.samplings);
        add_names("mode", run.modes);
        add_names("direction", run.directions);
        database.execute(views(runs()));
    });
}

void ResultFile::add_point(const std::string& name, const PointRecord& point) {
    auto& writer = state_->writer_of(*this, name);
    const RunRecord& run = writer.run;
    Statement& insert_sample = writer.sample;
    const PointResult& result = point.result;
    if (point.coordinates.size() != run.coordinates.size() || result.state.size() != run.states.size() ||
        (result.samples.size() > 0 && result.samples.width != run.values.size()))
        throw InputError(fmt::format("a point does not fit run '{}'", name), "give a value for each of its columns");
    const SampleSet& given = result.samples;
    require_size(given.samplings.size(), given.size(), "samplings of samples");
    require_size(given.values.size(), given.size() * given.width, "values of samples");
    for (const std::size_t sampling : given.samplings)
        require_index(sampling, run.samplings.size(), "sampling");
    require_index(result.mode, run.modes.size(), "mode");
    require_index(point.direction, run.directions.size(), "direction");
    state_->begin();
    try {
        write_point(writer.point, run, point);
        const SampleSet& samples = result.samples;
        const auto first = static_cast<std::int64_t>(point.number) * samples_of_a_point;
        for (std::size_t s = 0; s < samples.size(); ++s) {
            insert_sample.bind(1, first + static_cast<std::int64_t>(s))
                .bind(2, point.number)
                .bind(3, std::string_view(run.samplings[samples.samplings[s]]))
                .bind(4, samples.times[s]);
            for (std::size_t v = 0; v < samples.width; ++v)
                insert_sample.bind(5 + static_cast<int>(v), samples.values[s * samples.width + v]);
            insert_sample.run();
        }
        write_multipliers(writer.multiplier, name, point.number, result.multipliers);
        state_->commit_when_due();
    } catch (...) {
        state_->sqlite_rollback();
        state_->writer.reset();
        throw;
    }
}

void ResultFile::complete_run(const std::string& name) {
    state_->begin();
    state_->database.prepare("UPDATE runs SET status = ? WHERE name = ?")
        .bind(1, std::string_view(text_of(RunStatus::complete)))
        .bind(2, std::string_view(name))
        .run();
    flush();
}

std::size_t ResultFile::point_count(const std::string& name) const {
    const auto run = find_run(name);
    if (!run)
        return 0;
    Statement rows = state_->database.prepare("SELECT count(*) FROM " + RunTables(*run).points);
    rows.step();
    return static_cast<std::size_t>(rows.integer(0));
}

std::vector<PointRecord> ResultFile::last_points(const std::string& name, std::size_t chain_length) const {
    std::vector<PointRecord> points;
    const auto run = find_run(name);
    if (!run || run->is_branch() || chain_length == 0)
        return points;
    const RunTables tables(*run);
    Statement rows = state_->database.prepare(
        fmt::format("{0} WHERE number IN (SELECT max(number) FROM {1} GROUP BY number / {2}) ORDER BY number",
                    tables.select_point(), tables.points, chain_length));
    require_columns(rows, tables.point_columns(), path());
    while (rows.step())
        points.push_back(read_point(rows, *run));
    return points;
}

std::optional<PointRecord> ResultFile::point(const std::string& name, std::size_t number) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return std::nullopt;
    const RunTables tables(*run);
    Statement row = state_->database.prepare(tables.select_point() + " WHERE number = ?");
    row.bind(1, number);
    require_columns(row, tables.point_columns(), path());
    if (!row.step())
        return std::nullopt;
    PointRecord point = read_point(row, *run);
    SampleSet& samples = point.result.samples;
    samples.width = run->values.size();
    Statement rows = state_->database.prepare(
        fmt::format("SELECT * FROM {} WHERE rowid >= ?1 AND rowid < ?2 ORDER BY rowid", tables.samples));
    const auto first = static_cast<std::int64_t>(number) * samples_of_a_point;
    rows.bind(1, first).bind(2, first + samples_of_a_point);
    require_columns(rows, tables.sample_columns(), path());
    while (rows.step()) {
        samples.samplings.push_back(index_of(run->samplings, rows.text(1)));
        if (samples.samplings.back() == run->samplings.size())
            throw_contradiction(path(), fmt::format("run '{}' has no sampling '{}'", name, rows.text(1)));
        samples.times.push_back(rows.number(2));
        for (std::size_t v = 0; v < samples.width; ++v)
            samples.values.push_back(rows.number(3 + static_cast<int>(v)));
    }
    Statement multipliers = state_->database.prepare(
        "SELECT real, imaginary FROM multipliers WHERE run = ? AND point = ? ORDER BY position");
    multipliers.bind(1, std::string_view(name)).bind(2, number);
    point.result.multipliers = read_multipliers(multipliers);
    return point;
}

std::optional<PointRecord> ResultFile::nearest_point(const std::string& name, const std::string& coordinate,
                                                     double value, std::optional<std::size_t> direction) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return std::nullopt;
    const RunTables tables(*run);
    for (std::size_t i = 0; i < run->coordinates.size(); ++i) {
        if (run->coordinates[i].name != coordinate)
            continue;
        const std::string direction_name =
            direction && *direction < run->directions.size() ? run->directions[*direction] : "";
        Statement row = state_->database.prepare(fmt::format("SELECT number FROM {} WHERE ?2 = '' OR direction = ?2 "
                                                             "ORDER BY abs({} - ?1), number LIMIT 1",
                                                             tables.points, quoted_name(tables.coordinates[i])));
        row.bind(1, value).bind(2, std::string_view(direction_name));
        if (!row.step())
            return std::nullopt;
        return point(name, static_cast<std::size_t>(row.integer(0)));
    }
    return std::nullopt;
}

struct ResultFile::Rows::State {
    Statement statement;
    bool on_row = false;
    /// The number of a column of the present row.
    int at(std::size_t column) const {
        if (!on_row)
            throw std::logic_error("there is no row to be read: call next until it says that there is none");
        require_index(column, static_cast<std::size_t>(statement.columns()), "column");
        return static_cast<int>(column);
    }
};
ResultFile::Rows::Rows(std::unique_ptr<State> state) : state_(std::move(state)) {}
ResultFile::Rows::~Rows() = default;
ResultFile::Rows::Rows(Rows&&) noexcept = default;
bool ResultFile::Rows::next() {
    return state_->on_row = state_->statement.step();
}
std::size_t ResultFile::Rows::columns() const {
    return static_cast<std::size_t>(state_->statement.columns());
}
std::string ResultFile::Rows::column_name(std::size_t column) const {
    require_index(column, columns(), "column");
    return state_->statement.name(static_cast<int>(column));
}
bool ResultFile::Rows::is_null(std::size_t column) const {
    return state_->statement.is_null(state_->at(column));
}
bool ResultFile::Rows::is_text(std::size_t column) const {
    return state_->statement.type(state_->at(column)) == SQLITE_TEXT;
}
bool ResultFile::Rows::is_integer(std::size_t column) const {
    return state_->statement.type(state_->at(column)) == SQLITE_INTEGER;
}
double ResultFile::Rows::number(std::size_t column) const {
    return state_->statement.number(state_->at(column));
}
std::int64_t ResultFile::Rows::integer(std::size_t column) const {
    return state_->statement.integer(state_->at(column));
}
std::string ResultFile::Rows::text(std::size_t column) const {
    return state_->statement.text(state_->at(column));
}

ResultFile::Rows ResultFile::query(const std::string& sql, const std::vector<double>& values) const {
    auto state = std::make_unique<Rows::State>(Rows::State{state_->database.prepare_query(sql), false});
    for (std::size_t i = 0; i < values.size(); ++i)
        state->statement.bind(static_cast<int>(i) + 1, values[i]);
    return Rows(std::move(state));
}

} // namespace graze
