#include "graze/record/record_file.hpp"

#include "record/hdf5_record.hpp"
#include "record/text_record.hpp"

namespace graze {

std::unique_ptr<SampleSource> open_record(const std::string& path, const RecordLayout& layout) {
    if (!is_hdf5(path))
        return std::make_unique<TextRecord>(path, layout);
    if (!layout.columns.empty())
        throw InputError(Place{path, 0, 0}, "an HDF5 file says itself what its columns are",
                         "leave out what the columns are");
    return open_hdf5_record(path, layout);
}

} // namespace graze
