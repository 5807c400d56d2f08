#include "graze/study/study_schema.hpp"

#include "graze/study/study_keys.hpp"
#include "study/settings_fields.hpp"

namespace graze {

namespace {

using Texts = std::vector<std::string>;

/// Numbers may be expressions in the model's parameters.
void describe_type(SettingsWriter& fields, const StudyKey& key) {
    if (key.type == "whole number")
        fields.field("type", std::string("integer"));
    else if (key.type == "number")
        fields.field("type", Texts{"number", "string"});
    else if (key.type == "true or false")
        fields.field("type", std::string("boolean"));
    else if (key.type == "text")
        fields.field("type", std::string("string"));
    else if (key.type == "one of")
        fields.field("enum", key.words);
    if (key.least)
        fields.field(key.includes_least ? "minimum" : "exclusiveMinimum", *key.least);
    if (key.most)
        fields.field("maximum", *key.most);
}

void describe_key(SettingsWriter& fields, const StudyKey& key) {
    describe_type(fields, key);
    std::string text = key.meaning;
    if (!key.standard.empty())
        text += " (" + key.standard + ")";
    fields.field("description", text);
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

void describe_runs(SettingsWriter& runs) {
    runs.field("type", std::string("object"));
    runs.field("description", std::string("named runs: what is computed"));
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
        const auto text = [&](const char* name, const char* meaning) {
            all.object(name, [&](SettingsWriter& one) {
                one.field("type", std::string("string"));
                one.field("description", std::string(meaning));
            });
        };
        const auto other = [&](const char* name, const char* meaning) {
            all.object(name, [&](SettingsWriter& one) { one.field("description", std::string(meaning)); });
        };
        text("name", "of the study; its folder bears it");
        text("text", "what it does");
        text("source", "where it comes from");
        text("model", "name of a shipped model, or the path of a model file relative to the study");
        other("set", "values of parameters, for all runs");
        other("values", "what is sampled, for all runs that do not say");
        all.object("runs", [](SettingsWriter& runs) { describe_runs(runs); });
        other("pictures", "named pictures");
        other("tables", "named tables");
    });
    schema.field("additionalProperties", false);
    return schema.text() + "\n";
}

} // namespace graze
