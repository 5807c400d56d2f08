#pragma once

#include "base/temporary_folder.hpp"
#include "graze/acquire/experiment.hpp"
#include "graze/model/catalogue.hpp"
#include "instrument/scpi_bench.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace graze::testing {

/// Settings of a bench: the testbed with noise and converters.
inline BenchSettings testbed_bench() {
    BenchSettings settings;
    settings.model = load_model("electromagnetic-testbed");
    settings.amplitude = driven_input(settings.model, "V0", "--amplitude");
    settings.frequency = driven_input(settings.model, "f", "--frequency");
    for (const char* text : {"V=voltage:V", "I=I:A", "q=q:m", "v=v:m/s"})
        settings.channels.push_back(bench_channel(settings.model, text, "--channel"));
    settings.channels[3].noise = 1e-3;
    settings.channels[3].range = 1;
    return settings;
}

/// An experiment of six levels, up and down.
inline std::string experiment_text(const std::string& more = "", const std::string& port = "none",
                                   const std::string& device = "tcp:127.0.0.1:1") {
    return "name = \"sweep\"\n[generator]\nport = \"" + port +
           "\"\ntimeout = 0.2\nidentity = \"33120A\"\n"
           "[limits]\namplitude = 10\nsafe = 0.1\nfrequency = [1, 20]\n"
           "[samples]\ndevice = \"" +
           device +
           "\"\nrate = 500\ntimeout = 1\n"
           "[sweep]\nfrequency = 6.1\namplitude = { from = 9.4, to = 9.6, step = 0.1, back = true }\n"
           "[settle]\ntime = 0.5\n[record]\ntime = 1\n" +
           more;
}

/// Contents of all files of a folder, by name.
inline std::map<std::string, std::string> files_of(const std::string& folder) {
    std::map<std::string, std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        result[entry.path().filename().string()] = contents(entry.path());
    return result;
}

/// Names of files that differ between two folders, or exist in only one.
inline std::vector<std::string> different_files(const std::string& one, const std::string& other) {
    const auto first = files_of(one), second = files_of(other);
    std::vector<std::string> names;
    for (const auto& [name, text] : first)
        if (const auto found = second.find(name); found == second.end() || found->second != text)
            names.push_back(name);
    for (const auto& [name, text] : second)
        if (!first.contains(name))
            names.push_back(name);
    return names;
}

} // namespace graze::testing
