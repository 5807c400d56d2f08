#include "graze/results/hdf5.hpp"

#include "graze/symbolic/input_error.hpp"
#include "results/database.hpp"
#include "results/point_columns.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <filesystem>
#include <limits>
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
    Column(hid_t group, const std::string& name, ColumnType kind, const std::string& path)
        : kind_(kind), path_(&path),
          type_(kind == ColumnType::text    ? text_type(path)
                : kind == ColumnType::whole ? Handle(H5Tcopy(H5T_NATIVE_INT64), H5Tclose, path)
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
        if (kind_ == ColumnType::text)
            texts_.push_back(rows.text(column));
        else if (kind_ == ColumnType::whole)
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
        const void* data = kind_ == ColumnType::text    ? static_cast<const void*>(pointers.data())
                           : kind_ == ColumnType::whole ? static_cast<const void*>(wholes_.data())
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
    ColumnType kind_;
    const std::string* path_;
    Handle type_, set_;
    hsize_t size_ = 0, waiting_ = 0;
    std::vector<double> reals_;
    std::vector<std::int64_t> wholes_;
    std::vector<std::string> texts_;
};

/// A query's rows as a group with a dataset for each column. @param types of the columns, in their order
void write_table(hid_t parent, const std::string& name, ResultFile::Rows rows, const std::vector<ColumnType>& types,
                 const std::string& path) {
    const Handle group(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    if (rows.columns() != types.size())
        throw_contradiction(path,
                            fmt::format("table '{}' has {} columns instead of {}", name, rows.columns(), types.size()));
    std::vector<Column> columns;
    for (std::size_t c = 0; c < rows.columns(); ++c)
        columns.emplace_back(group.id(), rows.column_name(c), types[c], path);
    while (rows.next())
        for (std::size_t c = 0; c < columns.size(); ++c)
            columns[c].add(rows, c);
    for (Column& column : columns)
        column.flush();
}

std::vector<ColumnType> types_of(const std::vector<RunColumn>& columns) {
    std::vector<ColumnType> types;
    for (const RunColumn& column : columns)
        types.push_back(column.kind.type);
    return types;
}

void write_details(hid_t group, const ResultFile& file, const std::string& run, const DetailTable& table,
                   const std::string& path) {
    std::vector<ColumnType> types{ColumnType::whole, ColumnType::whole};
    for (const ColumnKind& column : table.columns)
        types.push_back(column.type);
    write_table(group, table.name,
                file.query(fmt::format("SELECT point, position, {} FROM {} WHERE run = {} ORDER BY point, position",
                                       listed(table.columns), table.name, text_literal(run))),
                types, path);
}

void write_run(hid_t output, const ResultFile& file, const RunRecord& run, const std::string& path) {
    const Handle group(H5Gcreate2(output, run.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    write_attribute(group.id(), "kind", run.kind, path);
    write_attribute(group.id(), "model_name", run.model_name, path);
    write_attribute(group.id(), "model", run.model, path);
    write_attribute(group.id(), "settings", run.settings, path);
    write_attribute(group.id(), "fingerprint", run.fingerprint, path);
    write_attribute(group.id(), "version", run.version, path);
    const RunTables tables(run);
    write_table(group.id(), run.is_branch() ? "orbits" : "points",
                file.query("SELECT * FROM " + tables.points + " ORDER BY number"), types_of(tables.point_columns),
                path);
    write_table(group.id(), run.is_branch() ? "segments" : "samples",
                file.query(fmt::format("SELECT * FROM {} ORDER BY {}", tables.samples,
                                       run.is_branch() ? "point, segment" : "rowid")),
                types_of(tables.sample_columns), path);
    for (const DetailTable& table : detail_tables())
        if (run.is_branch() || !table.of_branches)
            write_details(group.id(), file, run.name, table, path);
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
    for (const std::string& name : runs)
        if (const auto run = file.find_run(name))
            write_run(output.id(), file, *run, path);
    if (H5Fflush(output.id(), H5F_SCOPE_GLOBAL) < 0) // while it can still be told
        throw_full(path);
}

} // namespace graze
