#pragma once

#include "graze/layout/device_file.hpp"
#include "study/study_reader.hpp"

#include <span>
#include <string>

namespace graze {

/// Reads the sections of a design file that define the drawing; after an error in one the others are still read.
class DeviceFileReader {
public:
    explicit DeviceFileReader(const std::string& file) : reader_(file) { result_.file = file; }

    DeviceFile read(const toml::table& root, const GivenLengths& given);

private:
    /// Reads a length in micrometres, rounded to the grid.
    double length(const TomlEntry& entry, bool may_be_zero);
    template <class Section>
    bool read_length(std::span<const LengthField<Section>> fields, const TomlEntry& entry, Section& section);
    void read_device(const TomlEntry& entry);
    void read_process(const TomlEntry& entry);
    bool read_rule(const TomlEntry& item);
    void read_rules(const TomlEntry& entry);
    void read_wafer(const TomlEntry& entry);
    void read_wafer_item(const TomlEntry& entry);
    void read_vary(const TomlEntry& entry);
    bool take_condition(const std::string& name, double value, const Place& place);
    void take(const std::pair<std::string, double>& given);
    void require_layer() const;

    StudyReader reader_;
    DeviceFile result_;
    Mistakes mistakes_;
};

} // namespace graze
