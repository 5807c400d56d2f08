#include "graze/study/point_motion.hpp"
#include "picture/picture_kinds.hpp"
#include "picture/residual_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

/// The curves of one value, one for each record.
std::vector<Identification::Shown> shown_of(const StoredRun& run, const PointRecord& point, std::size_t value) {
    const SampleSet& samples = point.result.samples;
    std::map<double, Identification::Shown> records;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const double* row = samples.values.data() + s * samples.width;
        Identification::Shown& record = records[row[0]];
        const std::string& what = run.record.samplings[samples.samplings[s]];
        Identification::Curve& curve = what == "measured" ? record.measured
                                       : what == "fitted" ? record.fitted
                                                          : record.left;
        curve.x.push_back(row[1]);
        curve.y.push_back(row[value]);
    }
    std::vector<Identification::Shown> shown;
    for (auto& [number, record] : records)
        shown.push_back(std::move(record));
    return shown;
}

} // namespace

Figure residual_picture(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        if (run.record.kind != "identify" || run.record.values.size() < 3)
            throw InputError(picture.place, fmt::format("run '{}' fits nothing that could be left over", name),
                             "name a run of kind \"identify\"");
        const std::vector<std::string> known = run.value_names();
        std::vector<std::string> wanted = picture.y;
        if (wanted.empty())
            wanted.assign(known.begin() + 2, known.end());
        require_values(picture, run, wanted);
        const PointRecord point = chosen_point(run, {}, {}, picture.place);
        for (std::size_t v = 0; v < wanted.size(); ++v) {
            const auto at = std::find(known.begin(), known.end(), wanted[v]);
            add_residual_panels(figure, panel_of(picture, run, known[1], wanted[v], v),
                                shown_of(run, point, static_cast<std::size_t>(at - known.begin())));
        }
    }
    return figure;
}

} // namespace graze
