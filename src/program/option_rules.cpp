#include "program/option_rules.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/identify_request.hpp"
#include "program/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace graze {

namespace {

using Names = std::vector<std::string>;

/// An option beside which other options have no effect.
struct Excludes {
    const char* command;
    const char* option;
    const char* value; ///< the rule holds only for this value of the option; null: for any
    Names others;
    const char* remedy;
};

/// Options that have an effect only together with one of the others.
struct Needs {
    const char* command;
    Names options;
    Names others;
};

/// Options that have an effect only when another option has one of these values, or is not given.
struct NeedsValue {
    const char* command;
    const char* other;
    Names values;
    Names options;
    const char* unless = nullptr; ///< the rule does not apply when this option is given
};

const std::vector<Excludes>& exclusions() {
    static const std::vector<Excludes> all{
        {"export", "--sql", nullptr, {"--what", "--run", "--label", "--direction"}, "say it in the query"},
        {"export", "--what", "runs", {"--run", "--label", "--direction"}, "leave it out"},
        {"export",
         "--format",
         "hdf5",
         {"--what", "--label", "--direction", "--sql", "--digits", "--all"},
         "leave it out"},
        {"run",
         "--list",
         nullptr,
         {"STUDY", "--set", "--only", "--output", "--jobs", "--part", "--slurm", "--steps", "--show"},
         "leave it out"},
        {"run",
         "--keys",
         nullptr,
         {"STUDY", "--set", "--only", "--output", "--jobs", "--part", "--slurm", "--steps", "--show", "--schema",
          "--list"},
         "leave it out"},
        {"run",
         "--schema",
         nullptr,
         {"STUDY", "--set", "--only", "--output", "--jobs", "--part", "--slurm", "--steps", "--show", "--list",
          "--format"},
         "leave it out"},
        {"run",
         "--show",
         nullptr,
         {"--set", "--only", "--output", "--jobs", "--part", "--slurm", "--steps", "--format"},
         "leave it out"},
        {"run", "--slurm", nullptr, {"--part"}, "leave one of them out"},
        {"run", "--slurm", nullptr, {"--jobs"}, "tell SLURM instead, as by -- --cpus-per-task=4"},
        {"run", "--quiet", nullptr, {"--format"}, "leave one of them out"},
        {"atlas", "--quiet", nullptr, {"--format", "--what", "--digits", "--all"}, "leave one of them out"},
        {"atlas", "--along", nullptr, {"--run"}, "leave it out: the atlas is the only one"},
        {"design",
         "--list",
         nullptr,
         {"DESIGN", "--output", "--jobs", "--no-pictures", "--quiet", "--show"},
         "leave it out"},
        {"design",
         "--show",
         nullptr,
         {"--output", "--jobs", "--no-pictures", "--quiet", "--format", "--digits"},
         "leave it out"},
        {"design", "--quiet", nullptr, {"--format", "--digits"}, "leave one of them out"},
        {"layout",
         "--from-design",
         nullptr,
         {"--yield"},
         "leave --from-design out, and give --set @FOLDER/drawing.toml, which it has written"},
        {"models", "--show", nullptr, {"--format", "--digits"}, "leave it out"},
        {"models", "--write", nullptr, {"--format", "--digits"}, "leave it out"},
        {"orbit",
         "--plot",
         nullptr,
         {"--quantity", "--samples", "--format", "--digits", "--output", "--all"},
         "name what is drawn by --x and --y, or leave the picture out"},
        {"trip", "--plot", nullptr, {"--format", "--digits", "--output", "--all"}, "leave the picture out"},
        {"record",
         "--write",
         nullptr,
         {"--what", "--format", "--digits", "--output", "--all", "--plot", "--data"},
         "leave one of them out"},
        {"record", "--plot", nullptr, {"--format", "--digits", "--output", "--all"}, "leave the picture out"},
        {"bench", "--on-demand", nullptr, {"--speed"}, "leave one of them out"},
        {"help", "--write", nullptr, {"COMMAND", "--man"}, "leave it out"},
        {"simulate", "--samples", nullptr, {"--every"}, "choose one of them"},
    };
    return all;
}

const std::vector<Needs>& needs() {
    static const std::vector<Needs> all{
        {"run", {"--no-wait", "--sbatch"}, {"--slurm"}},
        {"atlas",
         {"--set", "--from", "--section", "--starts", "--draws", "--seed", "--contacts", "--multiple", "--branches",
          "--curves", "--minutes", "--output", "--jobs", "--no-pictures", "--progress", "--quiet"},
         {"--along"}},
        {"layout", {"--mask"}, {"--picture", "--output"}},
        {"layout", {"--folder", "--seed"}, {"--yield"}},
        {"layout", {"--jobs"}, {"--yield", "--from-design"}},
        {"orbit", {"--data"}, {"--plot"}},
        {"trip", {"--data"}, {"--plot"}},
        {"record", {"--data"}, {"--plot"}},
        {"identify", {"--data"}, {"--plot"}},
        {"bench", {"--bits"}, {"--range"}},
        {"bench", {"--break-for"}, {"--break-after"}},
        {"acquire", {"--reference", "--phase", "--channel"}, {"--live"}},
        {"record",
         {"--level", "--hysteresis", "--reference", "--phase", "--negate", "--displacement", "--window", "--transition",
          "--least-jump", "--part"},
         {"--what"}},
        {"simulate", {"--event"}, {"--contact-table", "--contacts", "--minima", "--table", "--plot"}},
    };
    return all;
}

const std::vector<NeedsValue>& needs_of_values() {
    static const std::vector<NeedsValue> all{
        {"plot", "--kind", {"regression"}, {"--fit", "--group", "--successive"}},
        {"plot", "--kind", {"history", "portrait", "poincare", "spectrum"}, {"--at"}},
        {"plot", "--kind", {"history", "portrait"}, {"--point"}},
        {"record", "--what", {"periods", "sections", "extremes"}, {"--level", "--hysteresis", "--reference"}},
        {"record", "--what", {"sections"}, {"--phase", "--negate"}},
        {"record", "--what", {"impacts"}, {"--displacement", "--window", "--transition", "--least-jump"}},
        {"record", "--what", {"spectrum"}, {"--part"}},
        {"identify", "WHAT", {"decrement", "restitution"}, {"--channel"}},
        {"identify", "WHAT", {"restitution", "coupling"}, {"--displacement"}},
        {"identify", "WHAT", {"coupling", "impedance"}, {"--current"}},
        {"identify", "WHAT", {"decrement"}, {"--peaks"}},
        {"identify", "WHAT", {"restitution"}, {"--window", "--transition", "--least-jump"}},
        {"identify", "WHAT", {"coupling", "impedance"}, {"--gap"}},
        {"identify", "WHAT", {"coupling"}, {"--stiffness", "--gap-error", "--stiffness-error", "--noise"}},
        {"identify", "WHAT", {"impedance"}, {"--voltage", "--frequency", "--beta1", "--beta2", "--clamped"}},
        {"identify",
         "WHAT",
         {"fit"},
         {"--free", "--set", "--with", "--start", "--known", "--mode", "--reading", "--gain", "--offset", "--deviation",
          "--loss", "--piece", "--table", "--save"}},
        {"identify", "WHAT", kinds_of_estimates(), {"--columns", "--group", "--scale", "--from", "--to", "--plot"}},
        {"simulate", "--table", {"samples"}, {"--samples", "--every"}},
        {"simulate", "--table", {"derivatives"}, {"--derivatives"}},
        {"simulate", "--table", {"contacts", "minima", "summary"}, {"--event"}, "--contacts"},
    };
    return all;
}

bool given(const CLI::App& command, const std::string& option) {
    return command.count(option) > 0;
}

std::string option_value(const CLI::App& command, const std::string& option) {
    const auto values = command.get_option(option)->results();
    return values.empty() ? "" : values.front();
}

[[noreturn]] void refuse_option(const std::string& option, const std::string& other, const std::string& why,
                                const std::string& remedy) {
    const std::string shown = option == "--sbatch" ? "what follows --" : option;
    throw InputError(Place{}, fmt::format("{} has no effect {} {}", shown, why, other), remedy);
}

/// Refuses the file name `-`, which means standard output to other programs and would give a file of that name.
void refuse_dashes(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        const std::string type = option->get_type_name();
        if ((type != "FILE" && type != "FOLDER") || option->empty() || option->results().front() != "-")
            continue;
        const std::string name = option->get_name();
        const bool shows = name == "--write" && command.get_option_no_throw("--show") != nullptr;
        throw InputError(Place{fmt::format("{} -", name), 0, 0}, "'-' is no name of a file or folder",
                         fmt::format("{} text goes to standard output; ./- is a file that is called so",
                                     shows ? "with --show instead" : "without the option"));
    }
}

} // namespace

void refuse_useless_options(const CLI::App& app) {
    for (const CLI::App* command : app.get_subcommands()) {
        const std::string name = command->get_name();
        refuse_dashes(*command);
        for (const Excludes& rule : exclusions()) {
            if (name != rule.command || !given(*command, rule.option) ||
                (rule.value && option_value(*command, rule.option) != rule.value))
                continue;
            for (const std::string& other : rule.others)
                if (given(*command, other))
                    refuse_option(
                        other, fmt::format("{}{}{}", rule.option, rule.value ? " " : "", rule.value ? rule.value : ""),
                        "beside", rule.remedy);
        }
        const auto is_given = [&](const std::string& option) { return given(*command, option); };
        for (const NeedsValue& rule : needs_of_values()) {
            if (name != rule.command || !is_given(rule.other) || (rule.unless && is_given(rule.unless)))
                continue;
            const std::string value = option_value(*command, rule.other);
            if (std::find(rule.values.begin(), rule.values.end(), value) != rule.values.end())
                continue;
            for (const std::string& option : rule.options)
                if (is_given(option))
                    refuse_option(
                        option, fmt::format("{} {}", rule.other, value), "beside",
                        fmt::format("leave it out, or choose {} {}", rule.other, fmt::join(rule.values, " or ")));
        }
        for (const Needs& rule : needs())
            if (name == rule.command && std::none_of(rule.others.begin(), rule.others.end(), is_given))
                for (const std::string& option : rule.options)
                    if (is_given(option))
                        refuse_option(option, fmt::format("{}", fmt::join(rule.others, " or ")), "without",
                                      fmt::format("add {} or leave it out", rule.others.back()));
    }
}

} // namespace graze
