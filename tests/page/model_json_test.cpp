#include "page/model_json.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/model_table.hpp"
#include "page/json_text.hpp"
#include "page/page_results.hpp"
#include "page/simulation_json.hpp"

namespace graze {
namespace {

TEST(ModelJson, HasTheParametersAndStatesOfShippedModels) {
    for (const std::string& name : shipped_models()) {
        const Model model = load_model(name);
        const nlohmann::json json = nlohmann::json::parse(json_text(model_json(model)));
        EXPECT_EQ(json["name"], model.name);
        EXPECT_EQ(json["duration"], usual_duration(model)) << name;
        const std::vector<double> values = all_parameter_values(model), initial = model.initial_state();
        ASSERT_EQ(json["parameters"].size(), values.size()) << name;
        for (std::size_t i = 0; i < values.size(); ++i) {
            EXPECT_EQ(json["parameters"][i]["name"], model.parameters[i].name);
            EXPECT_EQ(json["parameters"][i]["unit"], model.parameters[i].unit);
            EXPECT_EQ(json["parameters"][i]["value"], values[i]);
            EXPECT_EQ(json["parameters"][i]["dependent"], !model.parameters[i].value.has_value());
        }
        ASSERT_EQ(json["states"].size(), initial.size()) << name;
        for (std::size_t i = 0; i < initial.size(); ++i) {
            EXPECT_EQ(json["states"][i]["initial"], initial[i]);
            EXPECT_EQ(json["states"][i]["cyclic"], model.states[i].period.has_value());
            EXPECT_EQ(json["states"][i]["drifting"], model.states[i].drifting);
        }
        // Its text is a model again, and what it names can be shown.
        EXPECT_EQ(write_model(parse_model(json["text"].get<std::string>(), name)), write_model(model)) << name;
        EXPECT_EQ(json["drawing"].is_null(), !model.drawing) << name;
    }
}

TEST(ModelJson, KeepsTheTextThatIsGiven) {
    EXPECT_EQ(model_json(load_model("bouncing-ball"), "# mine")["text"], "# mine");
}

TEST(ModelJson, ShowsADrawingWhoseNumbersAMotionHas) {
    for (const std::string& name : shipped_models()) {
        const Model model = load_model(name);
        const nlohmann::json json = model_json(model);
        if (json["drawing"].is_null())
            continue;
        EXPECT_LT(json["drawing"]["x"][0].get<double>(), json["drawing"]["x"][1].get<double>()) << name;
        SimulationWish wish;
        wish.duration = 1e-9 * usual_duration(model);
        for (const nlohmann::json& shape : json["drawing"]["shapes"])
            for (const nlohmann::json& point : shape["points"])
                for (const nlohmann::json& coordinate : point)
                    wish.names.push_back(coordinate.get<std::string>());
        EXPECT_EQ(simulation_json(model, wish)["values"].size(), 1 + wish.names.size()) << name;
    }
}

TEST(ModelJson, ShowsHostileTextsAsTexts) {
    const Model model = parse_model(R"(
name = "m"
text = "</script><script>alert('x')</script>"
[states]
x = { initial = "1", text = "\"quoted\" <b>" }
[modes.only]
rates = { x = "-x" }
)",
                                    "m.toml");
    const std::string text = json_text(model_json(model));
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(text)["words"], model.text);
}

} // namespace
} // namespace graze
