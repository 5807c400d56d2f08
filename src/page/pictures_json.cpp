#include "page/pictures_json.hpp"

namespace graze {

nlohmann::json pictures_json(const Study& study) {
    nlohmann::json list = nlohmann::json::array();
    for (const StudyPicture& picture : study.pictures)
        list.push_back({{"name", picture.name},
                        {"kind", picture.kind},
                        {"title", picture.title},
                        {"runs", picture.runs},
                        {"over", picture.over},
                        {"x", picture.x},
                        {"y", picture.y},
                        {"samples", picture.samplings},
                        {"directions", picture.directions},
                        {"points", picture.points}});
    return list;
}

} // namespace graze
