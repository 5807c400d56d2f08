#include "graze/results/hdf5.hpp"

#include "graze/base/input_error.hpp"
#include "results/database.hpp"
#include "results/point_columns.hpp"
#include "results/run_query.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

namespace graze {

namespace {

/// Small enough that reading one number is fast, and large enough to be compressed well.
constexpr hsize_t bytes_of_a_chunk = 65536;
/// In bytes. A column with a longer text has texts of variable length, since padding would make all of them as long.
constexpr std::size_t longest_padded_text = 65536;
/// In bytes. Columns up to this size are not chunked, since chunks would take more space than compression saves.
constexpr hsize_t largest_plain_column = 512;
constexpr unsigned deflate_level = 6; ///< the default of zlib
/// Half the number of entries in a node of the index of chunks. The default of HDF5, 32, takes 2 KiB in each dataset.
constexpr unsigned chunks_in_half_a_node = 4;

/// An identifier of the HDF5 library, closed by the destructor.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t), const std::string& path) : id_(id), close_(close) {
        if (id < 0)
            throw FileError(path, "the HDF5 file cannot be written",
                            "look at the permissions of the folder and the room on the disk");
    }
    ~Handle() {
        if (id_ >= 0)
            close_(id_);
    }
    Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    hid_t id() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

[[noreturn]] void throw_full(const std::string& path) {
    throw FileError(path, "the HDF5 file cannot be written", "make room on the disk");
}

Handle text_type(std::size_t size, H5T_cset_t letters, const std::string& path) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, path);
    H5Tset_size(type.id(), size);
    H5Tset_strpad(type.id(), size == H5T_VARIABLE ? H5T_STR_NULLTERM : H5T_STR_NULLPAD);
    H5Tset_cset(type.id(), letters);
    return type;
}

/// Writes a text of variable length: h5py reads texts of fixed length as bytes, and object headers limit their length.
void write_attribute(hid_t object, const char* name, const std::string& text, const std::string& path) {
    const Handle type = text_type(H5T_VARIABLE, H5T_CSET_UTF8, path), space(H5Screate(H5S_SCALAR), H5Sclose, path);
    const Handle attribute(H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
    const char* data = text.c_str();
    if (H5Awrite(attribute.id(), type.id(), &data) < 0)
        throw_full(path);
}

/// Description of a column that is going to be written.
struct ColumnPlan {
    std::string name, unit;
    ColumnType kind = ColumnType::real;
    hsize_t rows = 0;
    std::size_t longest = 0; ///< bytes of its longest text
    bool ascii = true;       ///< whether all of its texts are ASCII

    bool is_variable() const { return kind == ColumnType::text && longest > longest_padded_text; }
    /// Number of bytes of a cell.
    std::size_t cell() const {
        if (kind != ColumnType::text)
            return sizeof(double);
        return is_variable() ? sizeof(char*) : std::max<std::size_t>(1, longest);
    }
    hsize_t chunk() const {
        const hsize_t most = std::max<hsize_t>(1, bytes_of_a_chunk / cell()), chunks = (rows + most - 1) / most;
        return (rows + chunks - 1) / chunks; // so that all chunks have nearly the same size
    }
    Handle type(const std::string& path) const {
        if (kind == ColumnType::text) // ASCII if possible, since Octave does not read UTF-8
            return text_type(is_variable() ? H5T_VARIABLE : cell(), ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8, path);
        return {H5Tcopy(kind == ColumnType::whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE), H5Tclose, path};
    }
};

Handle make_dataset(hid_t group, const ColumnPlan& plan, hid_t type, const std::string& path) {
    const Handle space(H5Screate_simple(1, &plan.rows, nullptr), H5Sclose, path);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
    H5Pset_obj_track_times(properties.id(), false); // without times, equal results give equal files
    if (plan.rows * plan.cell() > largest_plain_column) {
        const hsize_t chunk = plan.chunk();
        H5Pset_chunk(properties.id(), 1, &chunk);
        H5Pset_shuffle(properties.id());
        H5Pset_deflate(properties.id(), deflate_level);
    }
    std::string name = plan.name;
    std::replace(name.begin(), name.end(), '/', '|'); // a slash would separate groups
    Handle set(H5Dcreate2(group, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose,
               path);
    if (!plan.unit.empty())
        write_attribute(set.id(), "units", plan.unit, path);
    return set;
}

/// One column, written chunk by chunk.
class Column {
public:
    Column(hid_t group, ColumnPlan plan, const std::string& path)
        : plan_(std::move(plan)), path_(&path), type_(plan_.type(path)),
          set_(make_dataset(group, plan_, type_.id(), path)) {}

    void add(const ResultFile::Rows& rows, std::size_t column) {
        if (plan_.kind == ColumnType::text)
            add_text(rows.text(column));
        else if (plan_.kind == ColumnType::whole)
            add_number(rows.is_null(column) ? std::int64_t{-1} : rows.integer(column));
        else
            add_number(rows.is_null(column) ? std::numeric_limits<double>::quiet_NaN() : rows.number(column));
        if (++waiting_ == plan_.chunk())
            flush();
    }
    void flush() {
        if (waiting_ == 0)
            return;
        std::vector<const char*> pointers;
        for (const std::string& text : texts_)
            pointers.push_back(text.c_str());
        const void* data = plan_.is_variable() ? static_cast<const void*>(pointers.data()) : cells_.data();
        const Handle target(H5Dget_space(set_.id()), H5Sclose, *path_),
            source(H5Screate_simple(1, &waiting_, nullptr), H5Sclose, *path_);
        if (H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, &written_, nullptr, &waiting_, nullptr) < 0 ||
            H5Dwrite(set_.id(), type_.id(), source.id(), target.id(), H5P_DEFAULT, data) < 0)
            throw_full(*path_);
        written_ += waiting_;
        waiting_ = 0;
        cells_.clear();
        texts_.clear();
    }

private:
    template <class Number>
    void add_number(Number number) {
        const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
        cells_.insert(cells_.end(), bytes.begin(), bytes.end());
    }
    void add_text(std::string text) {
        if (plan_.is_variable()) {
            texts_.push_back(std::move(text));
            return;
        }
        text.resize(plan_.cell(), '\0');
        cells_.insert(cells_.end(), text.begin(), text.end());
    }

    ColumnPlan plan_;
    const std::string* path_;
    Handle type_, set_;
    hsize_t written_ = 0, waiting_ = 0;
    std::vector<char> cells_; ///< bytes of the waiting cells, except texts of variable length
    std::vector<std::string> texts_;
};

/// Determines the number of rows of a query and the lengths of its texts.
void measure(std::vector<ColumnPlan>& plans, const ResultFile& file, const std::string& query) {
    std::string asked = "count(*)";
    for (const ColumnPlan& plan : plans)
        if (plan.kind == ColumnType::text) {
            const std::string text = quoted_name(plan.name), bytes = fmt::format("length(CAST({} AS BLOB))", text);
            asked += fmt::format(", max({0}), max({0} > length({1}))", bytes, text);
        }
    ResultFile::Rows found = file.query(fmt::format("SELECT {} FROM ({})", asked, query));
    found.next();
    std::size_t at = 1;
    for (ColumnPlan& plan : plans) {
        plan.rows = static_cast<hsize_t>(found.integer(0));
        if (plan.kind == ColumnType::text) {
            plan.longest = static_cast<std::size_t>(found.integer(at++));
            plan.ascii = found.integer(at++) == 0;
        }
    }
}

/// Writes the rows of a query as a group with a dataset for each column.
/// @param plans columns in the order of the query, with the names that they have in it
void write_table(hid_t parent, const std::string& name, const ResultFile& file, const std::string& query,
                 std::vector<ColumnPlan> plans, const std::string& path) {
    const Handle group(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    ResultFile::Rows rows = file.query(query);
    if (rows.columns() != plans.size())
        throw_contradiction(path,
                            fmt::format("table '{}' has {} columns instead of {}", name, rows.columns(), plans.size()));
    measure(plans, file, query);
    std::vector<Column> columns;
    for (ColumnPlan& plan : plans)
        columns.emplace_back(group.id(), std::move(plan), path);
    while (rows.next())
        for (std::size_t c = 0; c < columns.size(); ++c)
            columns[c].add(rows, c);
    for (Column& column : columns)
        column.flush();
}

std::vector<ColumnPlan> plans_of(const std::vector<RunColumn>& columns, const StoredRun& run) {
    std::vector<ColumnPlan> plans;
    for (const RunColumn& column : columns)
        plans.push_back({column.column, unit_of(column, run), column.kind.type});
    return plans;
}

void write_hdf5_details(hid_t group, const StoredRun& run, const DetailTable& table, const std::string& path) {
    std::vector<ColumnPlan> plans{{"point", "", ColumnType::whole}, {"position", "", ColumnType::whole}};
    for (const ColumnKind& column : table.columns)
        plans.push_back({column.name, unit_of(column.unit, run), column.type});
    write_table(group, table.name, run.file,
                fmt::format("SELECT point, position, {} FROM {} WHERE run = {} ORDER BY point, position",
                            listed(table.columns), table.name, text_literal(run.record.name)),
                std::move(plans), path);
}

/// Writes the estimates of a run, in which each row has its own unit.
void write_estimates(hid_t group, const StoredRun& run, const std::string& path) {
    if (run.file.estimates(run.record.name).numbers.empty())
        return;
    const std::string where = " WHERE run = " + text_literal(run.record.name);
    const auto whole = [](const char* name) { return ColumnPlan{name, "", ColumnType::whole}; };
    const auto real = [](const char* name) { return ColumnPlan{name, "", ColumnType::real}; };
    const auto text = [](const char* name) { return ColumnPlan{name, "", ColumnType::text}; };
    write_table(group, "estimates", run.file,
                "SELECT position, name, unit, value, error, low, high, freedom, note FROM estimates" + where +
                    " ORDER BY position",
                {whole("position"), text("name"), text("unit"), real("value"), real("error"), real("low"), real("high"),
                 real("freedom"), text("note")},
                path);
    write_table(group, "covariances", run.file,
                "SELECT position, other, covariance FROM covariances" + where + " ORDER BY position, other",
                {whole("position"), whole("other"), real("covariance")}, path);
}

void write_run(hid_t output, const StoredRun& stored, const std::string& path) {
    const RunRecord& run = stored.record;
    const Handle group(H5Gcreate2(output, run.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    for (const auto& [name, text] : {std::pair("kind", &run.kind),
                                     {"model_name", &run.model_name},
                                     {"model", &run.model},
                                     {"settings", &run.settings},
                                     {"fingerprint", &run.fingerprint},
                                     {"version", &run.version}})
        write_attribute(group.id(), name, *text, path);
    const RunTables tables(run);
    write_table(group.id(), run.is_branch() ? "orbits" : "points", stored.file,
                tables.select_point() + " ORDER BY number", plans_of(tables.point_columns, stored), path);
    write_table(group.id(), run.is_branch() ? "segments" : "samples", stored.file,
                tables.select_sample() + " ORDER BY " + (run.is_branch() ? "point, segment" : "rowid"),
                plans_of(tables.sample_columns, stored), path);
    for (const DetailTable& table : detail_tables())
        if (run.is_branch() || !table.of_branches)
            write_hdf5_details(group.id(), stored, table, path);
    write_estimates(group.id(), stored, path);
}

Handle make_file(const std::string& path) {
    const Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path);
    H5Pset_istore_k(properties.id(), chunks_in_half_a_node);
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties.id(), H5P_DEFAULT), H5Fclose, path};
}

} // namespace

void export_hdf5(const ResultFile& file, const std::vector<std::string>& runs, const std::string& path) {
    std::error_code none; // an error means that a file does not exist, so that the files are different
    if (std::filesystem::equivalent(path, file.path(), none))
        throw InputError(fmt::format("'{}' is the result file itself", path), "name another file for the export");
    for (const std::string& name : runs)
        if (!file.find_run(name))
            throw InputError(fmt::format("the result file has no run '{}'", name), "see graze points");
    H5dont_atexit(); // at exit, the library would write again what a full disk has refused, and crash
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // errors are reported by exceptions
    const Handle output = make_file(path);
    // A query that has not ended keeps a snapshot of the file, so that the lengths found by `measure` stay valid while
    // another process writes.
    ResultFile::Rows moment = file.query("SELECT 1 FROM runs");
    moment.next();
    for (const std::string& name : runs)
        write_run(output.id(), StoredRun(file, name, {}), path);
    if (H5Fflush(output.id(), H5F_SCOPE_GLOBAL) < 0) // before the destructor, which cannot report errors
        throw_full(path);
}

} // namespace graze
