#include "base/message_of.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/orbit/signature.hpp"

#include <gtest/gtest.h>

namespace graze::signature_test {

std::string rewritten(const char* model_name, const char* text) {
    const Model model = load_model(model_name);
    const Signature signature = parse_signature(model, text);
    validate_signature(model, signature);
    const std::string written = to_string(model, signature);
    EXPECT_EQ(parse_signature(model, written), signature) << written;
    return written;
}

TEST(Signature, RepetitionsAndSeparatorsAreNormalised) {
    EXPECT_EQ(rewritten("impact-microactuator", "{J1,J8}^2"), "(J1 J8)^2");
    EXPECT_EQ(rewritten("impact-microactuator", "J5"), "J5");
    EXPECT_EQ(rewritten("impact-microactuator", "{J1 J8}^10, J1, J8"), "(J1 J8)^11");
    EXPECT_EQ(rewritten("impact-oscillator", "impact^3"), "impact^3");
    EXPECT_EQ(rewritten("electromagnetic-testbed", "phase0"), "phase0");
}

TEST(Signature, HomoclinicOrbitsEndAtTheirSaddle) {
    EXPECT_EQ(rewritten("impact-oscillator", "impact^2 saddle"), "impact^2 free:saddle");
    EXPECT_EQ(rewritten("impact-oscillator", "~ saddle"), "free:~ free:saddle");
    const Model model = load_model("impact-oscillator");
    const Signature signature = parse_signature(model, "impact saddle");
    EXPECT_TRUE(is_homoclinic(signature));
    EXPECT_FALSE(is_homoclinic(parse_signature(model, "impact")));
    const auto message = [&](const char* text) { return testing::message_of([&] { parse_signature(model, text); }); };
    EXPECT_NE(message("saddle impact").find("write 'saddle' once, at the end"), std::string::npos)
        << message("saddle impact");
    EXPECT_NE(testing::message_of([&] {
                  validate_signature(model, {signature[1], signature[0]});
              }).find("let that be its last segment"),
              std::string::npos);
}

TEST(Signature, ModesFollowFromTheGraph) {
    const Model model = load_model("impact-microactuator");
    const Signature signature = parse_signature(model, "J1 J8");
    EXPECT_EQ(model.modes[signature[0].mode].name, "stick");
    EXPECT_EQ(model.modes[signature[1].mode].name, "slip_plus");
}

std::string message(const char* text) {
    const Model model = load_model("impact-microactuator");
    return testing::message_of([&] { parse_signature(model, text, {"study.toml", 3, 10}); });
}

TEST(Signature, MistakesAreReportedWithTheirPlace) {
    EXPECT_NE(message("J1 J99").find("study.toml:3:13: in the signature 'J1 J99': the model has no transition"),
              std::string::npos)
        << message("J1 J99");
    EXPECT_NE(message("J5 J1 J9").find("no cycle"), std::string::npos) << message("J5 J1 J9");
    EXPECT_NE(message("J8 J6").find("'J6' cannot follow 'J8'"), std::string::npos) << message("J8 J6");
    EXPECT_NE(message("{J1").find("not closed"), std::string::npos);
    EXPECT_NE(message("J1)").find("closes nothing"), std::string::npos);
    EXPECT_NE(message("J1^0").find("repetitions"), std::string::npos);
    EXPECT_NE(message("J1^x").find("repetitions"), std::string::npos);
    EXPECT_NE(message("J1^99999 J8^99999").find("too many"), std::string::npos);
    EXPECT_NE(message("").find("empty"), std::string::npos);
    EXPECT_NE(message("J1;J8").find("does not belong"), std::string::npos);
    EXPECT_NE(message("J1 \u00e9").find("'\u00e9' does not belong"), std::string::npos) << message("J1 \u00e9");
}

} // namespace graze::signature_test
