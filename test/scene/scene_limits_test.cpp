#include <gtest/gtest.h>
#include <sys/resource.h>

#include <random>

#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::sound_scene;

TEST(SceneLimits, aliasesThatMultiplyAreRefused) {
  std::string text = "a: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i <= 12; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1);
    text += "b" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + alias;
    for (int k = 1; k < 10; ++k) text += ", " + alias;
    text += "]\n";
  }
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("more than 1000000 values"), std::string::npos) << errors[0];
}

TEST(SceneLimits, aliasesThatNestAreRefused) {
  std::string text = "a0: &a0 [x]\n";
  for (int i = 1; i <= 40; ++i)
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("nested deeper than 32 levels"), std::string::npos) << errors[0];
}

TEST(SceneLimits, anAliasInsideOfWhatItNamesIsRefused) {
  EXPECT_TRUE(has_line(errors_of("a: &a [*a]\n"), "line 1, column 8: an alias inside"));
}

TEST(SceneLimits, deepTextIsRefused) {
  for (const char* open : {"[", "{a: ", "- ", "? "}) {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += open;
    const auto errors = errors_of(text);
    ASSERT_EQ(errors.size(), 1u) << open;
    EXPECT_LT(errors[0].size(), 200u);
  }
}

/// [kB] the most that this process has had in memory.
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// A parser that keeps all tokens of a line, or of a list in brackets, has hundreds of bytes for each byte of these.
TEST(SceneLimits, textsThatCannotBeReadTakeLittleMemory) {
  constexpr long allowed = 300'000;  // [kB]
  for (const std::string piece : {"[", "{a: ", "- ", "? ", "\"a\" ", "&a ", "!a ", "a: [", "\"", "[]", "[1,", ": "}) {
    std::string text = piece == "[1," ? "a: [" : "";
    while (text.size() < 15'000'000) text += piece;
    const long before = peak_memory();
    EXPECT_EQ(errors_of(text).size(), 1u) << piece;
    EXPECT_LT(peak_memory() - before, allowed) << piece;
  }
}

TEST(SceneLimits, moreObstaclesThanAStepCanLookAtAreRefused) {
  std::string text = sound_scene + "obstacles:\n";
  for (int i = 0; i < 10'001; ++i) text += "- {name: o" + std::to_string(i) + ", type: sphere, radius: 0.1}\n";
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0], "obstacles: 10001 obstacles; allowed: at most 10000");
}

/// As programs write them, on one line.
TEST(SceneLimits, aLargeSceneInJsonIsRead) {
  constexpr int count = 60'000;
  std::string text = "\n {\"particles\": [";
  for (int i = 0; i < count; ++i)
    text += (i == 0 ? "" : ", ") + ("{\"name\": \"p" + std::to_string(i)) + "\", \"mass\": 1, \"position\": [0, 0, 1]}";
  const SceneDesc scene = read_scene_text(text + "]}\n");
  EXPECT_EQ(scene.particles.size(), static_cast<std::size_t>(count));
}

TEST(SceneLimits, placesInJsonAreThoseOfTheText) {
  EXPECT_TRUE(has_line(errors_of("{\"a\": &a [*a]}"), "line 1, column 11: an alias inside"));
  EXPECT_TRUE(has_line(errors_of("\n\n  {\"a\": &a [*a]}"), "line 3, column 13: an alias inside"));
  EXPECT_TRUE(has_line(errors_of("\n{\"a\":\n &a [*a]}"), "line 3, column 6: an alias inside"));
  EXPECT_TRUE(has_line(errors_of("{\"a\": \"\\y\"}"), "line 1, column 10: unknown escape character"));
}

/// What yaml-cpp keeps up to its end: an element of a list.
TEST(SceneLimits, aValueWithTooManySignsSaysWhatToDo) {
  std::string flow = "frame_id: [[", lines = "frame_id:\n -\n";
  for (int i = 0; i < 400'000; ++i) {
    flow += "[], ";
    lines += "  - []\n";
  }
  EXPECT_EQ(errors_of(flow + "]]\n"),
            std::vector<std::string>{"line 1: more than 1000000 signs [ ] { } , : and others in one value in brackets; "
                                     "allowed: its lists with one element a line, each after \"- \""});
  EXPECT_TRUE(has_line(errors_of(lines), "frame_id: [[")) << joined(errors_of(lines));
}

TEST(SceneLimits, nulBytesAreNamed) {
  const std::string nul(1, '\0'), error = ": a NUL byte; allowed: text in UTF-8, or in UTF-16 or UTF-32 with a byte order mark";
  const std::string scene = sound_scene;
  const auto lines = std::count(scene.begin(), scene.end(), '\n');
  for (const std::string& end : {nul, "# " + nul, "a: \"" + nul + "\"\n", "\"" + nul})
    EXPECT_EQ(errors_of(scene + end), std::vector<std::string>{"line " + std::to_string(lines + 1) + error});
  EXPECT_EQ(errors_of(nul + scene), std::vector<std::string>{"line 1" + error});
}

TEST(SceneLimits, whatIsNoTextIsNamed) {
  const std::string end = ", which is not UTF-8; allowed: text in UTF-8, or in UTF-16 or UTF-32 with a byte order mark";
  EXPECT_EQ(errors_of("# caf\xc3\xa9\nframe_id: l\xe9\n"), std::vector<std::string>{"line 2: the byte \"\\xe9\"" + end});
  EXPECT_EQ(errors_of("\xed\xa0\x80: 1\n"), std::vector<std::string>{"line 1: the byte \"\\xed\"" + end});
}

TEST(SceneLimits, wideTextWithAByteOrderMarkIsRead) {
  for (const int size : {2, 4}) {
    for (const bool big : {false, true}) {
      std::string text;
      const auto add = [&](unsigned character) {
        for (int i = 0; i < size; ++i) text += static_cast<char>(character >> 8 * (big ? size - 1 - i : i) & 0xff);
      };
      add(0xfeff);
      for (const char c : std::string(sound_scene)) add(static_cast<unsigned char>(c));
      EXPECT_EQ(joined(errors_of(text)), "") << size << big;
    }
  }
}

/// Signs in texts and comments are no brackets.
TEST(SceneLimits, bracketsInTextsAreRead) {
  std::string comment(999, '[');
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(errors_of(sound_scene + std::string("# ") + comment + "\n").empty());
  const auto errors = errors_of("frame_id: [\n" + comment + comment);
  ASSERT_EQ(errors.size(), 1u);
}

TEST(SceneLimits, errorsAreCountedNotPiledUp) {
  std::string text = sound_scene;
  for (int i = 0; i < 5000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  const auto errors = errors_of(text);
  EXPECT_EQ(errors.size(), 501u);
  EXPECT_EQ(errors.back(), "and 4500 more errors");
}

TEST(SceneLimits, longValuesAreShortInMessages) {
  const auto errors =
      errors_of("frame_id: world\ncables: " + std::string(1000000, 'x') + "\n" + std::string(1000, 'k') + ": 3\n");
  EXPECT_EQ(errors.size(), 2u) << joined(errors);
  for (const std::string& error : errors) EXPECT_LT(error.size(), 550u);  // it lists the keys of a scene
}

TEST(SceneLimits, aLargeSceneIsRead) {
  constexpr int nodes = 50001;
  std::string text =
      "materials: {m: {linear_density: 1, radius: 1}}\ncables:\n  - name: c\n    length: 50\n    segments: 50000\n    material: "
      "m\n";
  text += "    initial:\n      type: points\n      points:\n";
  for (int i = 0; i < nodes; ++i) text += "        - [" + std::to_string(i) + "e-3, 0, 1]\n";
  const SceneDesc scene = read_scene_text(text);
  ASSERT_EQ(scene.cables[0].initial.points.size(), static_cast<std::size_t>(nodes));
  EXPECT_EQ(scene.cables[0].initial.points.back(), Vector3(50, 0, 1));
}

/// A scene that is read, or refused with reasons: never anything else.
void expect_an_answer(const std::string& text) {
  try {
    const SceneDesc scene = read_scene_text(text);
    EXPECT_EQ(joined(validate(scene)), "") << text;
  } catch (const SceneError& error) {
    ASSERT_FALSE(error.errors().empty()) << text;
    for (const std::string& line : error.errors()) EXPECT_EQ(line.find_first_of("\n\r\x1b"), std::string::npos) << text;
  }
}

TEST(SceneLimits, randomBytesGetAnAnswer) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    std::string text(random() % 200, ' ');
    for (char& c : text) c = static_cast<char>(random());
    expect_an_answer(text);
  }
}

TEST(SceneLimits, mutatedScenesGetAnAnswer) {
  const std::string pieces[] = {"[",     "]",      "{",       "}",         ":",
                                ",",     "-",      "\n",      " ",         "&a ",
                                "*a",    "!",      "|",       ">",         "\"",
                                "'",     "#",      "?",       "nan",       "-1",
                                "1e999", ".inf",   "~",       "[0, 0, 0]", "\t",
                                "%",     "@",      "settled", "points",    "points: [[0, 0, 0], [1, 0, 0]]",
                                "0",     "1e-300", "end",     "\xff",      std::string(1, '\0')};
  std::mt19937 random(2);
  for (int i = 0; i < 5000; ++i) {
    std::string text = sound_scene;
    for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      const std::size_t removed = random() % 3 == 0 ? random() % 20 : random() % 2;
      text.replace(at, removed, random() % 4 == 0 ? std::string() : pieces[random() % std::size(pieces)]);
      if (text.empty()) text = " ";
    }
    expect_an_answer(text);
  }
}

}  // namespace
}  // namespace verlet_cable
