#include "graze/record/record_file.hpp"

#include "record/record_formats.hpp"

namespace graze {

std::unique_ptr<SampleSource> open_record(const std::string& path, const RecordLayout& layout) {
    if (!is_hdf5(path)) {
        if (layout.group != RecordLayout().group)
            throw InputError(Place{path, 0, 0}, "a text file has no groups", "name a group only for HDF5 files");
        return open_text_record(path, layout);
    }
    if (!layout.columns.empty() || layout.skip > 0 || layout.names_line > 0 || layout.units_line > 0)
        throw InputError(Place{path, 0, 0}, "an HDF5 file names its columns itself",
                         "leave out the names of columns, and the lines of names");
    return open_hdf5_record(path, layout);
}

} // namespace graze
