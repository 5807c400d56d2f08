#include "layout/device_file_reader.hpp"

#include "design/design_keys.hpp"
#include "graze/base/file_name.hpp"
#include "graze/model/catalogue.hpp"
#include "layout/quantity_reader.hpp"
#include "layout/spread_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_values = 10'000;

using Wafer = LengthField<WaferPlan>;
constexpr std::array wafer_table{
    Wafer{"diameter", &WaferPlan::diameter, "of the wafer"},
    Wafer{"flat_length", &WaferPlan::flat_length, "of the flat; 0: none", true},
    Wafer{"exclusion", &WaferPlan::exclusion, "of the ring at the edge without devices", true},
    Wafer{"radius", &WaferPlan::radius, "of the circle of the devices", true},
    Wafer{"mark_radius", &WaferPlan::mark_radius, "of the circle of the wafer's marks"},
    Wafer{"mark_size", &WaferPlan::mark_size, "of the wafer's marks; 0: none", true},
    Wafer{"label_height", &WaferPlan::label_height, "of the letters on the wafer; 0: none", true},
};

constexpr const char* length_units = "nm, um, mm, cm or m";

template <class Section>
std::vector<std::string> names_of_fields(std::span<const LengthField<Section>> fields) {
    std::vector<std::string> names;
    for (const LengthField<Section>& field : fields)
        names.emplace_back(field.name);
    return names;
}

template <class Section>
const LengthField<Section>* field_named(std::span<const LengthField<Section>> fields, std::string_view name) {
    for (const LengthField<Section>& field : fields)
        if (name == field.name)
            return &field;
    return nullptr;
}

std::vector<std::string> names_of_process() {
    std::vector<std::string> names = names_of_fields(process_fields());
    for (const QuantityField<ProcessConditions>& field : condition_fields())
        names.emplace_back(field.name);
    return names;
}

[[noreturn]] void fail_unknown(const TomlEntry& entry, const std::string& section,
                               const std::vector<std::string>& known) {
    throw InputError(entry.place, fmt::format("unknown key '{}' in {}", entry.name, section),
                     study_name_remedy(entry.name, known));
}

} // namespace

double dimension_of_text(const std::string& name, const std::string& text, const Place& place) {
    for (const QuantityField<ProcessConditions>& field : condition_fields())
        if (name == field.name)
            return quantity_of_text(text, name, field.unit, place, place);
    const bool is_length = field_named(device_fields(), name) || field_named(process_fields(), name);
    return is_length ? quantity_of_text(text, name, "um", place, place, length_units)
                     : value_of_text(Model(), text, place);
}

double DeviceFileReader::length(const TomlEntry& entry, bool may_be_zero) {
    const double value = read_quantity(reader_, entry, "um", length_units);
    try {
        return length_on_grid(value, entry.path, may_be_zero);
    } catch (const InputError& error) {
        reader_.fail(entry, error.problem(), error.remedy());
    }
}

template <class Section>
bool DeviceFileReader::read_length(std::span<const LengthField<Section>> fields, const TomlEntry& entry,
                                   Section& section) {
    const LengthField<Section>* field = field_named(fields, entry.name);
    if (field)
        section.*field->member = length(entry, field->may_be_zero);
    return field != nullptr;
}

void DeviceFileReader::read_device(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        result_.places.emplace(item.path, reader_.toml().place(*item.node));
        if (item.name == "folds") {
            result_.device.folds = reader_.count(item, 1, most_folds);
        } else if (!read_length(device_fields(), item, result_.device)) {
            std::vector<std::string> known = names_of_fields(device_fields());
            known.emplace_back("folds");
            fail_unknown(item, entry.path, known);
        }
    });
}

void DeviceFileReader::read_process(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        result_.places.emplace(item.path, reader_.toml().place(*item.node));
        if (!read_length(process_fields(), item, result_.process) &&
            !read_quantity_field(reader_, condition_fields(), item, result_.conditions))
            fail_unknown(item, entry.path, names_of_process());
    });
}

bool DeviceFileReader::read_rule(const TomlEntry& item) {
    if (item.node->is_boolean() && !item.node->ref<bool>())
        for (const QuantityField<RuleLimits>& field : rule_fields())
            if (item.name == field.name) {
                result_.rules.*field.member = no_limit(field);
                return true;
            }
    try {
        return read_quantity_field(reader_, rule_fields(), item, result_.rules);
    } catch (const InputError& error) {
        throw InputError(error.place(), error.problem(), error.remedy() + ", or false for no such rule");
    }
}

void DeviceFileReader::read_rules(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        result_.places.emplace(item.path, reader_.toml().place(*item.node));
        if (read_rule(item))
            return;
        std::vector<std::string> known;
        for (const QuantityField<RuleLimits>& field : rule_fields())
            known.emplace_back(field.name);
        fail_unknown(item, entry.path, known);
    });
}

void DeviceFileReader::read_vary(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        result_.places.emplace(item.path, reader_.toml().place(*item.node));
        const LengthField<DeviceDimensions>* field = field_named(device_fields(), item.name);
        const bool folds = item.name == "folds";
        if (!field && !folds) {
            std::vector<std::string> known = names_of_fields(device_fields());
            known.emplace_back("folds");
            fail_unknown(item, entry.path, known);
        }
        const std::vector<TomlEntry> items = reader_.toml().elements(item);
        if (items.empty() || items.size() > most_values)
            reader_.fail(item, fmt::format("{} has {} values", item.path, items.size()),
                         fmt::format("give from 1 to {}", most_values));
        std::vector<double>& values = result_.wafer.vary.emplace_back(item.name, std::vector<double>()).second;
        reader_.each(items, [&](const TomlEntry& one) {
            values.push_back(folds ? static_cast<double>(reader_.count(one, 1, most_folds))
                                   : length(one, field->may_be_zero));
        });
    });
}

void DeviceFileReader::read_wafer_item(const TomlEntry& item) {
    if (item.name == "devices") {
        result_.wafer.devices = reader_.count(item, 1, most_devices_of_wafer);
    } else if (item.name == "label") {
        result_.wafer.label = reader_.toml().line(item);
    } else if (item.name == "vary") {
        read_vary(item);
    } else if (!read_length(std::span<const Wafer>(wafer_table), item, result_.wafer)) {
        std::vector<std::string> known = names_of_fields(std::span<const Wafer>(wafer_table));
        known.insert(known.end(), {"devices", "label", "vary"});
        fail_unknown(item, "wafer", known);
    }
}

void DeviceFileReader::read_wafer(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        result_.places.emplace(item.path, reader_.toml().place(*item.node));
        read_wafer_item(item);
    });
}

bool DeviceFileReader::take_condition(const std::string& name, double value, const Place& place) {
    for (const QuantityField<ProcessConditions>& field : condition_fields())
        if (name == field.name) {
            try {
                require_within(value, name, field.unit, field.least, field.greatest);
            } catch (const InputError& error) {
                throw InputError(place, error.problem(), error.remedy());
            }
            result_.conditions.*field.member = value;
            return true;
        }
    return false;
}

void DeviceFileReader::take(const std::pair<std::string, double>& given) {
    const std::string& name = given.first;
    const double value = given.second;
    const Place place = given_place(name);
    const auto set = [&](auto fields, auto& section, const std::string& bare) {
        const auto* field = field_named(fields, bare);
        if (!field)
            return false;
        try {
            section.*field->member = length_on_grid(value, name, field->may_be_zero);
        } catch (const InputError& error) {
            throw InputError(place, error.problem(), error.remedy());
        }
        return true;
    };
    if (set(device_fields(), result_.device, name)) {
        result_.places.insert_or_assign("device." + name, place);
    } else if (set(process_fields(), result_.process, name)) {
        result_.places.insert_or_assign("process." + name, place);
    } else if (take_condition(name, value, place)) {
        result_.places.insert_or_assign("process." + name, place);
    } else if (name == "folds") {
        if (!(value >= 1 && value <= most_folds && value == static_cast<double>(static_cast<std::size_t>(value))))
            throw InputError(place, fmt::format("folds is {}", value),
                             fmt::format("give a whole number from 1 to {}", most_folds));
        result_.device.folds = static_cast<std::size_t>(value);
        result_.places.insert_or_assign("device.folds", place);
    } else {
        std::vector<std::string> known = names_of_fields(device_fields());
        for (const std::string& one : names_of_process())
            known.push_back(one);
        known.emplace_back("folds");
        throw InputError(place, fmt::format("a device has no dimension '{}'", name), study_name_remedy(name, known));
    }
}

void DeviceFileReader::require_layer() const {
    const ProcessData& process = result_.process;
    if (!(process.chamber_depth < process.wafer_thickness))
        throw InputError(result_.place(is_given_place(result_.place("process.wafer_thickness"))
                                           ? "process.wafer_thickness"
                                           : "process.chamber_depth"),
                         fmt::format("the chambers, {:.6g} um deep, leave nothing of the wafer, {:.6g} um thick",
                                     process.chamber_depth, process.wafer_thickness),
                         "give a smaller chamber_depth or a greater wafer_thickness");
}

DeviceFile DeviceFileReader::read(const toml::table& root, const GivenLengths& given) {
    bool drawn = false;
    StudyReader::each(reader_.toml().entries(root, ""), [&](const TomlEntry& entry) {
        mistakes_.attempt([&] {
            require_design_key(reader_.toml(), entry);
            if (entry.name == "device" || entry.name == "process" || entry.name == "wafer" || entry.name == "rules" ||
                entry.name == "spread")
                result_.places.emplace(entry.name, entry.place);
            if (entry.name == "name") {
                result_.name = reader_.toml().string(entry);
                require_file_name(result_.name, "name of a design", reader_.toml().place(*entry.node));
            } else if (entry.name == "model") {
                const std::string model = reader_.toml().string(entry);
                result_.model = is_model_path(model) ? beside(result_.file, model) : model;
                result_.places.emplace(entry.name, reader_.toml().place(*entry.node));
            } else if (entry.name == "text") {
                result_.text = reader_.toml().string(entry);
            } else if (entry.name == "device") {
                drawn = true;
                read_device(entry);
            } else if (entry.name == "process") {
                read_process(entry);
            } else if (entry.name == "rules") {
                read_rules(entry);
            } else if (entry.name == "spread") {
                result_.spread = read_spread(reader_, entry);
            } else if (entry.name == "wafer") {
                read_wafer(entry);
            }
        });
    });
    mistakes_.throw_noted();
    if (result_.name.empty())
        throw InputError(Place{result_.file, 1, 1}, "the design has no name", "give name = \"...\" in its first line");
    if (!drawn)
        throw InputError(Place{result_.file, 1, 1}, "the design has no device to be drawn",
                         "add a table [device] with its dimensions (docs/layout.md)");
    for (const auto& one : given)
        mistakes_.attempt([&] { take(one); });
    mistakes_.throw_noted();
    require_layer();
    return std::move(result_);
}

} // namespace graze
