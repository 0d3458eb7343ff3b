#include "core/config.h"

#include <gtest/gtest.h>

#include "core/errors.h"

namespace vsslam {
namespace {

enum class Mode { strongest, last };
struct Inner {
  double gain = 1.5;
  std::vector<double> list{1, 2};
  void fields(Fields& f) {
    f("gain", gain, positive());
    f("list", list);
  }
};
struct Outer {
  double max_range_m = 100.0;
  int count = 3;
  Mode mode = Mode::strongest;
  Inner inner;
  std::optional<Inner> extra;
  std::vector<Inner> items;
  std::map<std::string, double> bounds;
  Vec3 position_m = Vec3::Zero();
  std::string name = "a: b";
  void fields(Fields& f) {
    f("max_range_m", max_range_m, positive());
    f("count", count, at_least(1));
    f.choice("mode", mode, {{"strongest", Mode::strongest}, {"last", Mode::last}});
    f("inner", inner);
    f("extra", extra);
    f("items", items);
    f("bounds", bounds);
    f("position_m", position_m);
    f("name", name);
    f.check(max_range_m > count, "max_range_m", "more than count");
  }
};

Outer load(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  Outer o;
  load_config_text(yaml, "x.yaml", o, {}, overrides);
  return o;
}
std::string error_of(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  try {
    load(yaml, overrides);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Config, LoadsOverDefaults) {
  const Outer o = load("count: 5\ninner: {gain: 2.5}\nitems:\n  - gain: 1\n  - {}\nextra: {gain: 4}\n"
                       "bounds: {ate: 0.5}\nmode: last\nposition_m: [1, 2, -3]\n");
  EXPECT_EQ(o.max_range_m, 100.0);
  EXPECT_EQ(o.count, 5);
  EXPECT_EQ(o.inner.gain, 2.5);
  EXPECT_EQ(o.inner.list, (std::vector<double>{1, 2}));
  ASSERT_EQ(o.items.size(), 2u);
  EXPECT_EQ(o.items[1].gain, 1.5);
  EXPECT_EQ(o.extra->gain, 4);
  EXPECT_EQ(o.bounds.at("ate"), 0.5);
  EXPECT_EQ(o.mode, Mode::last);
  EXPECT_EQ(o.position_m, Vec3(1, 2, -3));
}

TEST(Config, NamesPlaceExpectationAndNearestKey) {
  EXPECT_EQ(error_of("count: 5\nmax_rnage_m: 3\n"),
            "x.yaml:2:1: unknown key \"max_rnage_m\" (did you mean max_range_m?)");
  EXPECT_EQ(error_of("inner:\n  gain: -1\n"), "x.yaml:2:9: gain: expected more than 0, got -1");
  EXPECT_EQ(error_of("count: two\n"), "x.yaml:1:8: count: expected a whole number, got \"two\"");
  EXPECT_EQ(error_of("mode: lats\n"), "x.yaml:1:7: mode: unknown value \"lats\" (did you mean last?)");
  EXPECT_EQ(error_of("count: 1\ncount: 2\n"), "x.yaml:2:1: key \"count\" stands here twice");
  EXPECT_EQ(error_of("inner: 3\n"), "x.yaml:1:8: inner: expected a mapping of keys to values, got \"3\"");
  EXPECT_EQ(error_of("items: [1]\n"), "x.yaml:1:9: items: expected a list of mappings, got \"1\"");
  EXPECT_EQ(error_of("position_m: [1, 2]\n"), "x.yaml:1:13: position_m: expected a list of 3 numbers, got a list of 2");
  EXPECT_EQ(error_of("max_range_m: 2\n"), "x.yaml:1:14: max_range_m: expected more than count");
}

TEST(Config, RefusesWhatIsNotFinite) {
  EXPECT_NE(error_of("max_range_m: nan\n"), "");
  EXPECT_NE(error_of("max_range_m: .inf\n"), "");
  EXPECT_NE(error_of("max_range_m: 1e999\n"), "");
  EXPECT_NE(error_of("count: 99999999999\n"), "");
}

TEST(Config, BrokenYamlHasAPlace) { EXPECT_TRUE(error_of("a: [1, 2\nb: 3\n").starts_with("x.yaml:")); }

TEST(Config, SavesWhatItLoads) {
  Outer o;
  o.max_range_m = 0.1 + 0.2 + 100;
  o.items.resize(2);
  o.items[1].gain = 1e-300;
  o.extra = Inner{.gain = 7, .list = {}};
  o.bounds = {{"b", 2}, {"a", 1.0 / 3.0}};
  o.name = "yes: \"no\" # \n é";
  const std::string yaml = save_config(o);
  Outer back;
  load_config_text(yaml, "back.yaml", back);
  EXPECT_EQ(back.max_range_m, o.max_range_m);
  EXPECT_EQ(back.items[1].gain, 1e-300);
  EXPECT_EQ(back.bounds, o.bounds);
  EXPECT_EQ(back.name, o.name);
  EXPECT_TRUE(back.extra->list.empty());
  EXPECT_EQ(save_config(back), yaml);
}

TEST(Config, OverridesTakeUnambiguousTails) {
  EXPECT_EQ(load("count: 5\n", {{"inner.gain", "9"}}).inner.gain, 9);
  EXPECT_EQ(load("{}", {{"gain", "9"}}).inner.gain, 9);
  EXPECT_EQ(load("items: [{}, {}]\n", {{"items.1.gain", "3"}}).items[1].gain, 3);
  EXPECT_EQ(load("{}", {{"extra.gain", "3"}}).extra->gain, 3);
  EXPECT_NE(error_of("extra: {}\n", {{"gain", "9"}}).find("ambiguous"), std::string::npos);
  EXPECT_NE(error_of("{}", {{"max_rnage_m", "9"}}).find("did you mean max_range_m?"), std::string::npos);
  EXPECT_NE(error_of("items: [{}]\n", {{"items.4.gain", "3"}}), "");
  EXPECT_NE(error_of("{}", {{"count.x", "3"}}), "");
}

TEST(Config, AMistypedTailIsLookedUpWhereTheRestOfItPoints) {
  struct Whole {
    Outer outer;
    void fields(Fields& f) { f("outer", outer); }
  } whole;
  try {
    load_config_text("{}", "x.yaml", whole, {}, {{"inner.gian", "9"}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean gain?"), std::string::npos) << e.what();
  }
}

TEST(Config, ErrorLeavesTheConfigAsItWas) {
  Outer o;
  EXPECT_THROW(load_config_text("count: 7\nnope: 1\n", "x.yaml", o), InputError);
  EXPECT_EQ(o.count, 3);
}

struct Derived {
  std::optional<double> noise_m = 0.1;
  void fields(Fields& f) { f.automatic("noise_m", noise_m, positive()); }
};

TEST(Config, ANumberMayBeAutomatic) {
  Derived derived;
  load_config_text("noise_m: automatic", "test", derived);
  EXPECT_FALSE(derived.noise_m.has_value());
  EXPECT_EQ(save_config(derived), "noise_m: automatic\n");
  load_config_text("noise_m: 0.03", "test", derived);
  EXPECT_EQ(derived.noise_m, 0.03);
  EXPECT_THROW(load_config_text("noise_m: automagic", "test", derived), InputError);
  EXPECT_THROW(load_config_text("noise_m: -1", "test", derived), InputError);
}

}  // namespace
}  // namespace vsslam
