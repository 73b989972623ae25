#include "core/scene_file/json_reader.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

JsonNode node(const std::string& text) { return JsonNode::parse_text(text, "t.json"); }

/// Writes a file of this test's folder and gives its place.
fs::path write_json(const std::string& name, const std::string& text) {
    static const support::TemporaryFolder folder("json_reader_test");
    const fs::path file = folder.path() / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
}

template <class Action>
std::string error_of(const Action& action) {
    try {
        static_cast<void>(action());
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    return "no error";
}

TEST(JsonNode, ReadsEveryKindOfValue) {
    const JsonNode root = node(R"({"n": 1.5, "i": 1e6, "b": true, "s": "x", "a": [1, 2.5]})");
    EXPECT_EQ(root.at("n").as_number(), 1.5);
    EXPECT_EQ(root.at("i").as_integer_in(0, 1'000'000), 1'000'000);
    EXPECT_TRUE(root.at("b").as_bool());
    EXPECT_EQ(root.at("s").as_string(), "x");
    EXPECT_EQ(root.at("s").as_choice({"w", "x"}), 1U);
    EXPECT_EQ(root.at("a").as_numbers(2), (std::vector<double>{1, 2.5}));
    EXPECT_FALSE(root.find("absent").has_value());
    EXPECT_TRUE(root.has("n"));
    EXPECT_NO_THROW(root.finish());
}

TEST(JsonNode, NamesPlaceReasonAndAlternatives) {
    const JsonNode root = node(R"({"a": {"n": "x", "f": 1.5, "list": [1, "y"], "deep/er": {}}})");
    const JsonNode a = root.at("a");
    const auto error = [&](const auto& read) { return error_of([&] { return read(a); }); };
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("n").as_number(); }),
              "t.json: /a/n: expected a number, got \"x\"");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("f").as_integer_in(0, 9); }),
              "t.json: /a/f: expected a whole number, got 1.5");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("f").as_number_in(2, 3); }),
              "t.json: /a/f: 1.5 is out of range (from 2 to 3)");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("n").as_choice({"p", "q"}); }),
              "t.json: /a/n: \"x\" is none of the choices (p, q)");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("list").as_numbers(3).size(); }),
              "t.json: /a/list: expected an array of 3 numbers, got [1,\"y\"]");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("list").as_numbers(2).size(); }),
              "t.json: /a/list/1: expected a number, got \"y\"");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("deep/er").at("x").as_bool(); }),
              "t.json: /a/deep~1er: key \"x\" is missing (present: none)");
    EXPECT_EQ(error([](const JsonNode& n) { return n.at("f").as_bool(); }),
              "t.json: /a/f: expected true or false, got 1.5");
}

TEST(JsonNode, AsksWhetherANearWordWasMeant) {
    const JsonNode root = node(R"({"scnes": [], "version": 1, "bound": "hybird"})");
    const auto error = [&](const auto& read) { return error_of([&] { return read(root), 0; }); };
    EXPECT_EQ(error([](const JsonNode& n) { n.at("scenes"); }),
              "t.json: /: key \"scenes\" is missing: is \"scnes\" meant to be it? (present: bound, "
              "scnes, version)");
    EXPECT_EQ(error([](const JsonNode& n) { n.at("bound").as_choice({"single", "hybrid"}); }),
              "t.json: /bound: \"hybird\" is none of the choices: did you mean hybrid? (single, "
              "hybrid)");
    EXPECT_EQ(
        error_of([] { return node(R"({"ball": {"radius": 1}})").set("/bal/radius", "2"), 0; }),
        "t.json: setting /bal/radius: there is nothing of that name: did you mean ball?; / is "
        "an object with the keys: ball");
}

TEST(JsonNode, TakesNoKeyForMisspeltThatWasAskedFor) {
    const JsonNode root = node(R"({"to": [0, 0, 1]})");
    static_cast<void>(root.at("to"));
    EXPECT_EQ(error_of([&] { return root.at("up"), 0; }),
              "t.json: /: key \"up\" is missing (present: to)");
}

TEST(JsonNode, ReadsCountsWithALetterForThousands) {
    const auto whole = [](const std::string& text) {
        return node("\"" + text + "\"").as_integer_in(0, 10'000'000'000);
    };
    EXPECT_EQ(whole("100k"), 100'000);
    EXPECT_EQ(whole("100K"), 100'000);
    EXPECT_EQ(whole("1M"), 1'000'000);
    EXPECT_EQ(whole("1.5M"), 1'500'000);
    EXPECT_EQ(whole("1.1M"), 1'100'000);
    EXPECT_EQ(whole("2G"), 2'000'000'000);
    for (const std::string text :
         {"k", "1m", "1.0005k", "1e3k", "1kk", "1 k", "0x1k", "010k", "1000"})
        EXPECT_EQ(error_of([&] { return whole(text); }),
                  "t.json: /: expected a whole number, got \"" + text + "\"");
    for (const std::string text : {"-1k", "11G"})
        EXPECT_EQ(error_of([&] { return whole(text); }),
                  "t.json: /: \"" + text + "\" is out of range (from 0 to 10000000000)");
}

TEST(JsonNode, ReadsChoicesInCapitals) {
    EXPECT_EQ(node(R"("Diamond")").as_choice({"bk7", "diamond"}), 1U);
    EXPECT_EQ(node(R"("A")").as_choice({"a", "A"}), 1U) << "the word itself comes first";
}

TEST(JsonNode, WholeNumbersBeyondTheRangeAreRefusedNotWrapped) {
    for (const char* text : {"18446744073709551615", "9223372036854775808", "1e300", "-1e300"})
        EXPECT_NE(
            error_of([&] { return node(text).as_integer_in(0, INT64_MAX); }).find("out of range"),
            std::string::npos)
            << text;
    EXPECT_EQ(node("9223372036854775807").as_integer_in(0, INT64_MAX), INT64_MAX);
}

TEST(JsonNode, UnknownKeysAreNamedWithTheKnownOnesInTheOrderOfAsking) {
    const JsonNode ball = node(R"({"ball": {"bsdf": {"iro": 1.5}}})").at("ball").at("bsdf");
    static_cast<void>(ball.find("ior"));
    static_cast<void>(ball.find("dispersion"));
    EXPECT_EQ(
        error_of([&] { return ball.finish(), 0; }),
        "t.json: /ball/bsdf: unknown key \"iro\": did you mean ior? (known: ior, dispersion)");
}

TEST(JsonNode, KnownKeysAreSharedByTheNodesOfOneObject) {
    const JsonNode root = node(R"({"a": {"x": 1}})");
    static_cast<void>(root.at("a").find("x"));
    EXPECT_NO_THROW(root.at("a").finish());
}

TEST(JsonNode, ChildrenTakesObjectsAndLeavesTheRestUnknown) {
    const JsonNode root = node(R"({"type": "scene", "b": {}, "a": {}, "typo": 3})");
    static_cast<void>(root.at("type"));
    const auto children = root.children();
    ASSERT_EQ(children.size(), 2U);
    EXPECT_EQ(children[0].first, "a");
    EXPECT_EQ(children[1].first, "b");
    EXPECT_EQ(error_of([&] { return root.finish(), 0; }),
              "t.json: /: unknown key \"typo\": did you mean type? (known: type; with a name of "
              "its own: an "
              "object with a type, not 3)");
    EXPECT_EQ(root.others().size(), 1U);
    EXPECT_NO_THROW(root.finish());
}

TEST(JsonText, BrokenTextIsNamedByLineAndColumn) {
    const std::string error = error_of([] { return node("{\"a\":\n  1,,}"); });
    EXPECT_TRUE(error.starts_with("t.json: parse error at line 2, column 5")) << error;
    EXPECT_NE(error_of([] { return node(""); }).find("line 1"), std::string::npos);
    EXPECT_NE(error_of([] { return node("{\"a\": 1e999}"); }).find("1e999"), std::string::npos);
    EXPECT_NE(error_of([] { return node("{\"a\": NaN}"); }).find("line 1, column"),
              std::string::npos);
    EXPECT_NE(error_of([] { return node("\"\xff\""); }), "no error");
}

TEST(JsonText, DuplicateKeysAreErrorsAtTheirPointer) {
    EXPECT_EQ(error_of([] { return node(R"({"a": [1, {"b": 1, "b": 2}]})"); }),
              "t.json: /a/1/b: key \"b\" is given twice in one object");
    EXPECT_NO_THROW(node(R"({"a": {"b": 1}, "c": {"b": 1}})"));
}

TEST(JsonText, EndlessNestingIsAnErrorNotACrash) {
    const std::string error = error_of([] { return node(std::string(1'000'000, '[')); });
    EXPECT_NE(error.find("nested more than 64 levels deep"), std::string::npos) << error;
}

TEST(JsonCanonical, SortsKeysAndWritesEqualNumbersAlike) {
    EXPECT_EQ(node(R"({"b": 1.0, "a": [1e3, 0.1, -0.0, 1e300]})").canonical(),
              R"({"a":[1000,0.1,0,1e+300],"b":1})");
}

TEST(JsonSet, ReplacesAddsOneKeyAndReadsJsonOrText) {
    JsonNode root = node(R"({"a": {"b/c": 1}, "l": [1, 2]})");
    root.set("/a/b~1c", "[1, 2");
    root.set("/a/new", R"({"x": true})");
    root.set("/l/1", "2.5");
    EXPECT_EQ(root.canonical(), R"({"a":{"b/c":"[1, 2","new":{"x":true}},"l":[1,2.5]})");
}

TEST(JsonSet, APointerIntoNothingNamesWhatIsThere) {
    JsonNode root = node(R"({"a": {"b": 1}, "l": [1, 2]})");
    const std::string before = root.canonical();
    EXPECT_EQ(error_of([&] { return root.set("/q/r", "1"), 0; }),
              "t.json: setting /q/r: there is nothing of that name; / is an object with the keys: "
              "a, l");
    EXPECT_EQ(error_of([&] { return root.set("/a/c/d", "1"), 0; }),
              "t.json: setting /a/c/d: there is nothing of that name; /a is an object with the "
              "keys: b");
    EXPECT_EQ(error_of([&] { return root.set("/a/b/d", "1"), 0; }),
              "t.json: setting /a/b/d: there is nothing of that name; /a/b is 1");
    for (const char* pointer : {"/l/2", "/l/-", "/l/01", "/l/x"})
        EXPECT_NE(error_of([&] {
                      return root.set(pointer, "1"), 0;
                  }).find("/l is an array of 2 elements"),
                  std::string::npos)
            << pointer;
    for (const char* pointer : {"", "a/b", "/a~2"})
        EXPECT_NE(error_of([&] { return root.set(pointer, "1"), 0; }).find("not a JSON pointer"),
                  std::string::npos)
            << pointer;
    EXPECT_NE(error_of([&] { return root.set("/a/b", "{\"x\": 1, \"x\": 2}"), 0; }).find("twice"),
              std::string::npos);
    EXPECT_NE(error_of([&] { return root.set("/a/b", "\xff"), 0; }).find("UTF-8"),
              std::string::npos);
    EXPECT_EQ(root.canonical(), before);
}

TEST(JsonInclude, IsReplacedByTheFileAndErrorsNameThatFile) {
    write_json("parts/water.json", R"({"bsdf": {"iro": 1.33}, "mesh": "waves.ply"})");
    const fs::path file = write_json("pool.json", R"({"water": {"$include": "parts/water.json"}})");
    const fs::path water = file.parent_path() / "parts/water.json";
    const JsonNode root = JsonNode::parse_file(file);
    EXPECT_EQ(root.canonical(), R"({"water":{"bsdf":{"iro":1.33},"mesh":"waves.ply"}})");
    EXPECT_EQ(root.at("water").at("mesh").file(), water);
    EXPECT_EQ(root.file(), file);
    EXPECT_EQ(error_of([&] { return root.at("water").at("bsdf").finish(), 0; }),
              water.string() + ": /bsdf (included as /water/bsdf of " + file.string() +
                  "): unknown key \"iro\" (known: none)");
}

TEST(JsonInclude, SetReachesIntoIncludedFilesAndReplacedPartsForgetThem) {
    write_json("inner.json", R"({"x": {"y": 1}})");
    const fs::path file = write_json("outer.json", R"({"a": {"$include": "inner.json"}})");
    JsonNode root = JsonNode::parse_file(file);
    root.set("/a/x/y", "2");
    EXPECT_EQ(root.canonical(), R"({"a":{"x":{"y":2}}})");
    EXPECT_EQ(root.at("a").file(), file.parent_path() / "inner.json");
    root.set("/a", R"({"x": 1})");
    EXPECT_EQ(root.at("a").file(), file);
    root.set("/a", R"({"$include": "inner.json"})");
    EXPECT_EQ(root.canonical(), R"({"a":{"x":{"y":1}}})");
}

TEST(JsonInclude, TheSameFileMayBeIncludedTwiceButNotByItself) {
    write_json("leaf.json", "3");
    const fs::path twice =
        write_json("twice.json", R"([{"$include": "leaf.json"}, {"$include": "leaf.json"}])");
    EXPECT_EQ(JsonNode::parse_file(twice).canonical(), "[3,3]");
    const fs::path a = write_json("a.json", R"({"b": {"$include": "b.json"}})");
    write_json("b.json", R"({"a": {"$include": "./a.json"}})");
    const std::string error = error_of([&] { return JsonNode::parse_file(a); });
    EXPECT_NE(error.find("b.json: /a/$include: "), std::string::npos) << error;
    EXPECT_NE(error.find("includes itself"), std::string::npos) << error;
}

TEST(JsonInclude, FilesThatIncludeEachOtherTooOftenAreRefused) {
    write_json("many9.json", "1");
    for (int i = 0; i < 9; ++i) {
        std::string text = "[";
        for (int k = 0; k < 10; ++k)
            text += (k > 0 ? ", " : "") + std::string("{\"$include\": \"many") +
                    std::to_string(i + 1) + ".json\"}";
        write_json("many" + std::to_string(i) + ".json", text + "]");
    }
    const fs::path few = write_json("few.json", R"([{"$include": "many7.json"}])");
    EXPECT_EQ(JsonNode::parse_file(few).as_array()[0].as_array().size(), 10U);
    const fs::path many = write_json("many.json", R"([{"$include": "many0.json"}])");
    const std::string error = error_of([&] { return JsonNode::parse_file(many); });
    EXPECT_NE(error.find("more than 10000 inclusions"), std::string::npos) << error;
}

TEST(JsonInclude, WhatIsWrongWithItIsNamed) {
    const auto error = [](const std::string& text) {
        const fs::path file = write_json("bad.json", text);
        return error_of([&] { return JsonNode::parse_file(file); });
    };
    EXPECT_NE(error(R"({"a": {"$include": "leaf.json", "x": 1}})")
                  .find("bad.json: /a/$include: an object with \"$include\" may have no other key "
                        "(has $include, x)"),
              std::string::npos);
    EXPECT_NE(error(R"({"a": {"$include": 3}})").find("/a/$include: expected a file name, got 3"),
              std::string::npos);
    const std::string absent = error(R"({"a": {"$include": "absent.json"}})");
    EXPECT_NE(absent.find("absent.json: cannot be read"), std::string::npos) << absent;
    EXPECT_NE(absent.find("(included by "), std::string::npos) << absent;
    const std::string device = error(R"({"a": {"$include": "/dev/zero"}})");
    EXPECT_NE(device.find("/dev/zero: cannot be read (a pipe or device, not a regular file"),
              std::string::npos)
        << device;
    write_json("broken.json", "{");
    EXPECT_NE(error(R"({"a": {"$include": "broken.json"}})").find("broken.json: parse error"),
              std::string::npos);
}

TEST(JsonNode, HoldsNoControlCharacters) {
    for (const char* text :
         {R"({"a": "x\u0000"})", R"({"a": ["\u001b[2J"]})", R"({"a\u0000": 1})"}) {
        const std::string error = error_of([&] { return node(text); });
        EXPECT_NE(error.find("t.json: /"), std::string::npos) << error;
        EXPECT_NE(error.find("a control character in \""), std::string::npos) << error;
    }
    JsonNode root = node(R"({"a": 1})");
    EXPECT_NE(error_of([&] {
                  root.set("/a", "x\ny");
                  return 0;
              }).find("control character"),
              std::string::npos);
}

TEST(JsonFile, AFolderOrNothingIsAnError) {
    const fs::path file = write_json("x.json", "{}");
    EXPECT_NE(error_of([&] { return JsonNode::parse_file(file.parent_path()); }).find("folder"),
              std::string::npos);
    EXPECT_NE(error_of([&] { return JsonNode::parse_file(file / "y"); }).find("cannot be read"),
              std::string::npos);
}

}  // namespace
}  // namespace caustics
