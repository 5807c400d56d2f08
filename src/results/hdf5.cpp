#include "graze/results/hdf5.hpp"

#include "graze/symbolic/input_error.hpp"
#include "results/database.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <system_error>

namespace graze {

namespace {

constexpr hsize_t chunk = 8192;

/// Something of the HDF5 library that has to be closed.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t), const std::string& path) : id_(id), close_(close) {
        if (id < 0)
            throw InputError(Place{path, 0, 0}, "the HDF5 file cannot be written",
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
    throw InputError(Place{path, 0, 0}, "the HDF5 file cannot be written", "make room on the disk");
}

Handle text_type(const std::string& path) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, path);
    H5Tset_size(type.id(), H5T_VARIABLE);
    H5Tset_cset(type.id(), H5T_CSET_UTF8);
    return type;
}

void write_attribute(hid_t group, const char* name, const std::string& text, const std::string& path) {
    const Handle type = text_type(path), space(H5Screate(H5S_SCALAR), H5Sclose, path);
    const Handle attribute(H5Acreate2(group, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
    const char* data = text.c_str();
    if (H5Awrite(attribute.id(), type.id(), &data) < 0)
        throw_full(path);
}

/// One column, written chunk by chunk.
class Column {
public:
    enum class Kind { real, whole, text };
    Column(hid_t group, const std::string& name, Kind kind, const std::string& path)
        : kind_(kind), path_(&path), type_(kind == Kind::text    ? text_type(path)
                                           : kind == Kind::whole ? Handle(H5Tcopy(H5T_NATIVE_INT64), H5Tclose, path)
                                                                 : Handle(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose, path)),
          set_([&] {
              const hsize_t none = 0, unlimited = H5S_UNLIMITED;
              const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose, path);
              const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
              H5Pset_chunk(properties.id(), 1, &chunk);
              std::string safe = name;
              for (char& c : safe)
                  c = c == '/' ? '|' : c; // a path in HDF5
              return Handle(
                  H5Dcreate2(group, safe.c_str(), type_.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                  H5Dclose, path);
          }()) {}

    void add(const ResultFile::Rows& rows, std::size_t column) {
        if (kind_ == Kind::text)
            texts_.push_back(rows.text(column));
        else if (kind_ == Kind::whole)
            wholes_.push_back(rows.is_null(column) ? -1 : rows.integer(column));
        else
            reals_.push_back(rows.is_null(column) ? std::numeric_limits<double>::quiet_NaN() : rows.number(column));
        if (++waiting_ == chunk)
            flush();
    }
    void flush() {
        if (waiting_ == 0)
            return;
        const hsize_t start = size_, count = waiting_, whole = start + count;
        std::vector<const char*> pointers;
        for (const std::string& text : texts_)
            pointers.push_back(text.c_str());
        const void* data = kind_ == Kind::text    ? static_cast<const void*>(pointers.data())
                           : kind_ == Kind::whole ? static_cast<const void*>(wholes_.data())
                                                  : static_cast<const void*>(reals_.data());
        bool written = H5Dset_extent(set_.id(), &whole) >= 0;
        const Handle target(H5Dget_space(set_.id()), H5Sclose, *path_),
            source(H5Screate_simple(1, &count, nullptr), H5Sclose, *path_);
        written = written && H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr) >= 0 &&
                  H5Dwrite(set_.id(), type_.id(), source.id(), target.id(), H5P_DEFAULT, data) >= 0;
        if (!written)
            throw_full(*path_);
        size_ = whole;
        waiting_ = 0;
        reals_.clear();
        wholes_.clear();
        texts_.clear();
    }

private:
    Kind kind_;
    const std::string* path_;
    Handle type_, set_;
    hsize_t size_ = 0, waiting_ = 0;
    std::vector<double> reals_;
    std::vector<std::int64_t> wholes_;
    std::vector<std::string> texts_;
};

/// What the schema declares a column of a run's tables to be.
Column::Kind kind_of(const std::string& name, bool is_branch) {
    static const std::set<std::string> whole_of_points{"number", "chain",   "period", "symmetric",
                                                       "cycles", "returns", "point",  "position"};
    static const std::set<std::string> whole_of_branches{"number",     "step",       "stable",  "unstable",
                                                         "admissible", "iterations", "located", "event_segment",
                                                         "at_end",     "point",      "segment", "position"};
    static const std::set<std::string> texts{"direction", "label",    "signature", "mode",   "ending",
                                             "detail",    "sampling", "part",      "type",   "symmetry",
                                             "reason",    "outcome",  "event",     "tangent"};
    if ((is_branch ? whole_of_branches : whole_of_points).contains(name))
        return Column::Kind::whole;
    return texts.contains(name) ? Column::Kind::text : Column::Kind::real;
}

/// @param numbers columns that are named by a model or study: numbers, whatever their names
void write_table(hid_t parent, const char* name, ResultFile::Rows rows, bool is_branch,
                 const std::vector<std::string>& numbers, const std::string& path) {
    const Handle group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    std::vector<Column> columns;
    for (std::size_t c = 0; c < rows.columns(); ++c) {
        const std::string column = rows.column_name(c);
        const bool number = std::find(numbers.begin(), numbers.end(), column) != numbers.end();
        columns.emplace_back(group.id(), column, number ? Column::Kind::real : kind_of(column, is_branch), path);
    }
    while (rows.next())
        for (std::size_t c = 0; c < columns.size(); ++c)
            columns[c].add(rows, c);
    for (Column& column : columns)
        column.flush();
}

} // namespace

void export_hdf5(const ResultFile& file, const std::vector<std::string>& runs, const std::string& path) {
    std::error_code none; // files that are not there are not the same
    if (std::filesystem::equivalent(path, file.path(), none))
        throw InputError(fmt::format("'{}' is the result file itself", path), "name another file for the export");
    for (const std::string& name : runs)
        if (!file.find_run(name))
            throw InputError(fmt::format("the result file has no run '{}'", name), "see graze points");
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures are told by exceptions
    const Handle output(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path);
    for (const std::string& name : runs) {
        const auto run = file.find_run(name);
        if (!run)
            continue;
        const Handle group(H5Gcreate2(output.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                           path);
        write_attribute(group.id(), "kind", run->kind, path);
        write_attribute(group.id(), "model_name", run->model_name, path);
        write_attribute(group.id(), "model", run->model, path);
        write_attribute(group.id(), "settings", run->settings, path);
        write_attribute(group.id(), "fingerprint", run->fingerprint, path);
        write_attribute(group.id(), "version", run->version, path);
        const RunTables tables(*run);
        const bool branch = tables.is_branch;
        std::vector<std::string> of_points = tables.coordinates;
        const auto& more = branch ? tables.values : tables.states;
        of_points.insert(of_points.end(), more.begin(), more.end());
        write_table(group.id(), branch ? "orbits" : "points",
                    file.query("SELECT * FROM " + tables.points + " ORDER BY number"), branch, of_points, path);
        write_table(group.id(), branch ? "segments" : "samples",
                    file.query(fmt::format("SELECT * FROM {} ORDER BY {}", tables.samples,
                                           branch ? "point, segment" : "rowid")),
                    branch, branch ? tables.states : tables.values, path);
        const auto write_details = [&](const char* table, const char* columns,
                                       const std::vector<std::string>& numbers) {
            write_table(group.id(), table,
                        file.query(fmt::format("SELECT point, position, {} FROM {} WHERE run = '{}' "
                                               "ORDER BY point, position",
                                               columns, table, name)),
                        branch, numbers, path);
        };
        write_details("multipliers", "real, imaginary", {});
        if (branch) {
            write_details("half_multipliers", "real, imaginary", {});
            write_details("minima", "segment, event, time, value, size", {});
            write_details("end_values", "segment, event, value, rate", {});
        }
    }
    if (H5Fflush(output.id(), H5F_SCOPE_GLOBAL) < 0) // while it can still be told
        throw_full(path);
}

} // namespace graze
