#include "graze/study/study_schema.hpp"

#include "graze/study/study_keys.hpp"
#include "study/settings_fields.hpp"

#include <map>
#include <string>
#include <vector>

namespace graze {

namespace {

using Texts = std::vector<std::string>;

/// @param type empty: any
void describe_type(SettingsWriter& fields, const std::string& type, const std::string& meaning) {
    if (!type.empty())
        fields.field("type", type);
    fields.field("description", meaning);
}

/// Numbers may be expressions in the model's parameters.
void describe_key(SettingsWriter& fields, const StudyKey& key) {
    static const std::map<std::string, std::string> types{
        {"whole number", "integer"}, {"true or false", "boolean"}, {"text", "string"}};
    if (key.type == "number")
        fields.field("type", Texts{"number", "string"});
    else if (key.type == "one of")
        fields.field("enum", key.words);
    else if (const auto found = types.find(key.type); found != types.end())
        fields.field("type", found->second);
    if (key.least)
        fields.field(key.includes_least ? "minimum" : "exclusiveMinimum", *key.least);
    if (key.most)
        fields.field("maximum", *key.most);
    describe_type(fields, "", key.standard.empty() ? key.meaning : key.meaning + " (" + key.standard + ")");
}

void describe_kind(SettingsWriter& fields, const std::string& kind, const std::vector<StudyKey>& keys) {
    fields.object("if", [&](SettingsWriter& condition) {
        condition.object("properties", [&](SettingsWriter& one) {
            one.object("kind", [&](SettingsWriter& of) { of.field("const", kind); });
        });
        condition.field("required", Texts{"kind"});
    });
    fields.object("then", [&](SettingsWriter& run) {
        run.object("properties", [&](SettingsWriter& all) {
            for (const StudyKey& key : keys)
                all.object(key.name, [&](SettingsWriter& one) { describe_key(one, key); });
        });
        run.field("additionalProperties", false);
    });
}

void describe_all_runs(SettingsWriter& runs) {
    describe_type(runs, "object", "named runs: what is computed");
    runs.object("additionalProperties", [](SettingsWriter& run) {
        run.field("type", std::string("object"));
        run.field("required", Texts{"kind"});
        run.object("properties", [](SettingsWriter& all) {
            all.object("kind", [](SettingsWriter& kind) { kind.field("enum", kinds_of_runs()); });
        });
        run.list("allOf", kinds_of_runs(), [](SettingsWriter& one, const std::string& kind) {
            describe_kind(one, kind, study_keys(*run_kind(kind)));
        });
    });
}

} // namespace

std::string study_schema() {
    SettingsWriter schema;
    schema.field("$schema", std::string("http://json-schema.org/draft-07/schema#"));
    schema.field("title", std::string("a study of graze"));
    schema.field("type", std::string("object"));
    schema.field("required", Texts{"name", "runs"});
    schema.object("properties", [](SettingsWriter& all) {
        const auto property = [&](const char* name, const char* type, const char* meaning) {
            all.object(name, [&](SettingsWriter& one) { describe_type(one, type, meaning); });
        };
        property("name", "string", "of the study; its folder bears it");
        property("text", "string", "what it does");
        property("source", "string", "where it comes from");
        property("model", "string", "name of a shipped model, or the path of a model file relative to the study");
        property("set", "", "values of parameters, for all runs");
        property("values", "", "what is sampled, for all runs that do not say");
        all.object("runs", [](SettingsWriter& runs) { describe_all_runs(runs); });
        property("pictures", "", "named pictures");
        property("tables", "", "named tables");
    });
    schema.field("additionalProperties", false);
    return schema.text() + "\n";
}

} // namespace graze
