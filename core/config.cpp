#include "core/config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "core/files.h"
#include "core/suggestion.h"

namespace vsslam {

namespace fs = std::filesystem;

void Fields::operator()(const char* key, float& value, Range range) {
  double wide = value;
  if (!loading()) wide = std::stod(fmt::format("{}", value));  // 0.1f is saved as 0.1
  number(key, wide, range);
  if (loading()) value = static_cast<float>(wide);
}

void Fields::operator()(const char* key, int& value, Range range) {
  constexpr double kLow = std::numeric_limits<int>::min(), kHigh = std::numeric_limits<int>::max();
  range.low = std::max(range.low, kLow);
  range.high = std::min(range.high, kHigh);
  int64_t wide = value;
  integer(key, wide, range);
  value = static_cast<int>(wide);
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    std::vector<size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= word.size(); ++i) {
      size_t diagonal = row[0];
      row[0] = i;
      for (size_t j = 1; j <= candidate.size(); ++j) {
        const size_t substituted = diagonal + (word[i - 1] != candidate[j - 1]);
        diagonal = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

namespace {

constexpr const char* kAutomatic = "automatic";

std::string join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string hint(std::string_view word, const std::vector<std::string>& candidates) {
  return fmt::format(" ({})", suggestion(word, candidates));
}

template <class T>
bool parse_number(const std::string& text, T& value) {
  const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string describe(Range range) {
  if (std::isinf(range.low) && std::isinf(range.high)) return "a finite number";
  if (std::isinf(range.high)) return fmt::format("{} {}", range.low_open ? "more than" : "at least", range.low);
  if (std::isinf(range.low)) return fmt::format("at most {}", range.high);
  return fmt::format("{}{} to {}", range.low_open ? "above " : "", range.low, range.high);
}

// Walks the tree of a parsed file alongside the members of a struct.
class Loader final : public Fields {
 public:
  Loader(YAML::Node root, std::string file, fs::path folder, Library library, std::vector<fs::path> chain)
      : file_(std::move(file)), folder_(std::move(folder)), library_(std::move(library)), chain_(std::move(chain)) {
    if (root.IsNull()) root = YAML::Node(YAML::NodeType::Map);
    push(root);
  }

  /// Checks the keys of the outermost mapping; call after all members were visited.
  void finish() { leave(); }

  bool loading() const override { return true; }
  fs::path folder() const override { return folder_; }

  void check(bool ok, const char* key, const std::string& expected) override {
    if (ok) return;
    const YAML::Node value = child(key);
    fail(value ? value : top().node, fmt::format("{}: expected {}", key, expected));
  }

 protected:
  void number(const char* key, double& value, Range range) override {
    if (const YAML::Node n = take(key)) value = to_number(n, key, range);
  }
  void number_or_automatic(const char* key, std::optional<double>& value, Range range) override {
    const YAML::Node n = take(key);
    if (!n) return;
    double parsed = 0;
    if (n.IsScalar() && n.Scalar() == kAutomatic) {
      value.reset();
    } else if (n.IsScalar() && parse_number(n.Scalar(), parsed)) {
      check_range(n, key, parsed, range);
      value = parsed;
    } else {
      fail_type(n, key, fmt::format("a number or \"{}\"", kAutomatic));
    }
  }
  void integer(const char* key, int64_t& value, Range range) override {
    const YAML::Node n = take(key);
    if (!n) return;
    int64_t parsed = 0;
    if (!n.IsScalar() || !parse_number(n.Scalar(), parsed)) fail_type(n, key, "a whole number");
    check_range(n, key, static_cast<double>(parsed), range);
    value = parsed;
  }
  void unsigned_integer(const char* key, uint64_t& value) override {
    if (const YAML::Node n = take(key)) value = to_unsigned(n, key);
  }
  void boolean(const char* key, bool& value) override {
    const YAML::Node n = take(key);
    if (!n) return;
    if (n.IsScalar() && n.Scalar() == "true") {
      value = true;
    } else if (n.IsScalar() && n.Scalar() == "false") {
      value = false;
    } else {
      fail_type(n, key, "true or false");
    }
  }
  void text(const char* key, std::string& value) override {
    const YAML::Node n = take(key);
    if (!n) return;
    if (!n.IsScalar()) fail_type(n, key, "a text");
    value = n.Scalar();
  }
  void text_of(const char* key, std::string& value, const std::vector<std::string>& words) override {
    const YAML::Node n = take(key);
    if (!n) return;
    if (!n.IsScalar()) fail_type(n, key, "one of " + join(words));
    if (std::find(words.begin(), words.end(), n.Scalar()) == words.end())
      fail(n, fmt::format("{}: unknown value \"{}\"{}", key, n.Scalar(), hint(n.Scalar(), words)));
    value = n.Scalar();
  }
  void numbers(const char* key, double* values, size_t count, Range range) override {
    const YAML::Node n = take(key);
    if (!n) return;
    if (!n.IsSequence() || n.size() != count) fail_type(n, key, fmt::format("a list of {} numbers", count));
    for (size_t i = 0; i < count; ++i) values[i] = to_number(n[i], key, range);
  }
  bool enter(const char* key, bool) override {
    const YAML::Node n = take(key);
    if (!n) return false;
    if (n.IsNull()) return false;  // "section:" with nothing below keeps the defaults
    if (!n.IsMap()) fail_type(n, key, "a mapping of keys to values");
    push(n);
    return true;
  }
  bool enter_optional(const char* key, bool) override {
    note(key);
    return static_cast<bool>(child(key));
  }
  bool enter_list(const char* key, size_t& size) override {
    const YAML::Node n = take(key);
    if (!n) return false;
    if (!n.IsSequence()) fail_type(n, key, "a list");
    size = n.size();
    levels_.push_back({n, {}, {}, key});
    return true;
  }
  void enter_item(size_t index) override {
    const YAML::Node n = top().node[index];
    if (!n.IsMap()) fail_type(n, top().name.c_str(), "a list of mappings");
    push(n);
  }
  void leave() override {
    const Level level = top();
    levels_.pop_back();
    if (!level.node.IsMap()) return;
    for (const auto& entry : level.node) {
      const std::string key = entry.first.Scalar();
      if (std::find(level.known.begin(), level.known.end(), key) == level.known.end())
        fail(entry.first, fmt::format("unknown key \"{}\"{}", key, hint(key, level.known)));
    }
  }
  void item(size_t index, double& value) override {
    value = to_number(top().node[index], top().name.c_str(), any_value());
  }
  void item(size_t index, std::string& value) override {
    const YAML::Node n = top().node[index];
    if (!n.IsScalar()) fail_type(n, top().name.c_str(), "a list of texts");
    value = n.Scalar();
  }
  void item(size_t index, uint64_t& value) override {
    value = to_unsigned(top().node[index], top().name.c_str());
  }
  std::vector<std::string> keys_here() override {
    std::vector<std::string> keys;
    for (const auto& entry : top().node) keys.push_back(entry.first.Scalar());
    return keys;
  }
  void load_base(const char* kind, const std::function<void(Fields&)>& load) override {
    note("base");
    const YAML::Node n = child("base");
    if (!n) return;
    if (!n.IsScalar()) fail_type(n, "base", "a name or a path");
    const std::string name = n.Scalar();
    fs::path path;
    try {
      path = name.ends_with(".yaml") ? folder_ / name : (library_ ? library_(kind, name) : fs::path{});
    } catch (const InputError& e) {  // a library may know the nearest name
      fail(n, fmt::format("base: {}", e.what()));
    }
    if (path.empty()) fail(n, fmt::format("base: no \"{}\" among the {}", name, kind));
    if (std::find(chain_.begin(), chain_.end(), path) != chain_.end())
      fail(n, fmt::format("base: {} names itself as its base", path.string()));
    std::vector<fs::path> chain = chain_;
    chain.push_back(path);
    Loader inner(parse(read_file(path), path.string()), path.string(), path.parent_path(), library_, chain);
    load(inner);
    inner.finish();
  }

 public:
  static YAML::Node parse(const std::string& text, const std::string& file) {
    try {
      YAML::Node root = YAML::Load(text);
      if (!root.IsMap() && !root.IsNull())
        throw InputError(fmt::format("{}:1:1: expected a mapping of keys to values", file));
      return root;
    } catch (const YAML::Exception& e) {
      throw InputError(fmt::format("{}:{}:{}: {}", file, e.mark.line + 1, e.mark.column + 1, e.msg));
    }
  }

 private:
  struct Level {
    YAML::Node node;
    std::map<std::string, YAML::Node> children;
    std::vector<std::string> known;
    std::string name;
  };

  void push(const YAML::Node& node) {
    Level level{node, {}, {}, {}};
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) fail(entry.first, "expected a plain key");
      const std::string key = entry.first.Scalar();
      if (!level.children.emplace(key, entry.second).second)
        fail(entry.first, fmt::format("key \"{}\" stands here twice", key));
    }
    levels_.push_back(std::move(level));
  }
  Level& top() { return levels_.back(); }
  void note(const char* key) { top().known.emplace_back(key); }
  // yaml-cpp: a default-constructed node is "defined"; an undefined one must be made explicitly.
  YAML::Node child(const char* key) {
    const auto it = top().children.find(key);
    return it == top().children.end() ? YAML::Node(YAML::NodeType::Undefined) : it->second;
  }
  YAML::Node take(const char* key) {
    note(key);
    return child(key);
  }

  double to_number(const YAML::Node& n, const char* key, Range range) {
    double parsed = 0;
    if (!n.IsScalar() || !parse_number(n.Scalar(), parsed)) fail_type(n, key, "a number");
    check_range(n, key, parsed, range);
    return parsed;
  }
  uint64_t to_unsigned(const YAML::Node& n, const char* key) {
    uint64_t parsed = 0;
    if (!n.IsScalar() || !parse_number(n.Scalar(), parsed)) fail_type(n, key, "a whole number of 0 or more");
    return parsed;
  }
  void check_range(const YAML::Node& n, const char* key, double value, Range range) {
    const bool ok = std::isfinite(value) && value <= range.high &&
                    (range.low_open ? value > range.low : value >= range.low);
    if (!ok) fail(n, fmt::format("{}: expected {}, got {}", key, describe(range), n.Scalar()));
  }
  [[noreturn]] void fail_type(const YAML::Node& n, const char* key, const std::string& expected) {
    const std::string got = n.IsScalar()     ? fmt::format("\"{}\"", n.Scalar())
                            : n.IsSequence() ? fmt::format("a list of {}", n.size())
                            : n.IsMap()      ? "a mapping"
                                             : "nothing";
    fail(n, fmt::format("{}: expected {}, got {}", key, expected, got));
  }
  [[noreturn]] void fail(const YAML::Node& n, const std::string& message) {
    const YAML::Mark mark = n.Mark();
    const bool one_line = file_.starts_with("--set ");
    if (mark.is_null() || one_line) throw InputError(fmt::format("{}: {}", file_, message));
    throw InputError(fmt::format("{}:{}:{}: {}", file_, mark.line + 1, mark.column + 1, message));
  }

  std::string file_;
  fs::path folder_;
  Library library_;
  std::vector<fs::path> chain_;
  std::vector<Level> levels_;
};

class Saver final : public Fields {
 public:
  Saver() { out_ << YAML::BeginMap; }
  std::string finish() {
    out_ << YAML::EndMap;
    return std::string(out_.c_str()) + "\n";
  }
  bool loading() const override { return false; }
  void check(bool, const char*, const std::string&) override {}

 protected:
  void number(const char* key, double& value, Range) override { put(key) << fmt::format("{}", value); }
  void number_or_automatic(const char* key, std::optional<double>& value, Range) override {
    put(key) << (value ? fmt::format("{}", *value) : kAutomatic);
  }
  void integer(const char* key, int64_t& value, Range) override { put(key) << fmt::format("{}", value); }
  void unsigned_integer(const char* key, uint64_t& value) override { put(key) << fmt::format("{}", value); }
  void boolean(const char* key, bool& value) override { put(key) << (value ? "true" : "false"); }
  void text(const char* key, std::string& value) override { put(key) << value; }
  void text_of(const char* key, std::string& value, const std::vector<std::string>&) override {
    put(key) << value;
  }
  void numbers(const char* key, double* values, size_t count, Range) override {
    put(key) << YAML::Flow << YAML::BeginSeq;
    for (size_t i = 0; i < count; ++i) out_ << fmt::format("{}", values[i]);
    out_ << YAML::EndSeq;
  }
  bool enter(const char* key, bool worth_saving) override {
    if (!worth_saving) return false;
    put(key) << YAML::BeginMap;
    closing_.push_back(YAML::EndMap);
    return true;
  }
  bool enter_optional(const char*, bool present) override { return present; }
  bool enter_list(const char* key, size_t& size) override {
    put(key) << (size == 0 ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
    closing_.push_back(YAML::EndSeq);
    return true;
  }
  void enter_item(size_t) override {
    out_ << YAML::BeginMap;
    closing_.push_back(YAML::EndMap);
  }
  void leave() override {
    out_ << closing_.back();
    closing_.pop_back();
  }
  void item(size_t, double& value) override { out_ << fmt::format("{}", value); }
  void item(size_t, std::string& value) override { out_ << value; }
  void item(size_t, uint64_t& value) override { out_ << fmt::format("{}", value); }
  std::vector<std::string> keys_here() override { return {}; }
  void load_base(const char*, const std::function<void(Fields&)>&) override {}

 private:
  YAML::Emitter& put(const char* key) { return out_ << YAML::Key << key << YAML::Value; }
  YAML::Emitter out_;
  std::vector<YAML::EMITTER_MANIP> closing_;
};

// Every full path of a saved config, "a.b.c", sections included.
void list_paths(const YAML::Node& node, const std::string& prefix, std::vector<std::string>& paths) {
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    const std::string path = prefix + entry.first.Scalar();
    paths.push_back(path);
    list_paths(entry.second, path + ".", paths);
  }
}

std::string full_path(const std::string& path, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), path) != known.end()) return path;
  std::vector<std::string> tails;
  for (const std::string& candidate : known)
    if (candidate.ends_with("." + path)) tails.push_back(candidate);
  if (tails.size() == 1) return tails.front();
  if (tails.size() > 1)
    throw InputError(fmt::format("--set {}: ambiguous, one of: {}", path, join(tails)));
  // A list item, an optional section or a wrong key, below what the rest of the path names. Loading reports it.
  const size_t dot = path.rfind('.');
  return dot == std::string::npos ? path : full_path(path.substr(0, dot), known) + path.substr(dot);
}

void apply(YAML::Node root, const Override& override_, const std::vector<std::string>& known) {
  const std::string path = full_path(override_.path, known);
  YAML::Node node = root;
  size_t begin = 0;
  while (true) {
    const size_t dot = path.find('.', begin);
    const std::string key = path.substr(begin, dot - begin);
    const bool last = dot == std::string::npos;
    YAML::Node next(YAML::NodeType::Undefined);
    if (node.IsSequence()) {
      size_t index = 0;
      if (!parse_number(key, index) || index >= node.size())
        throw InputError(fmt::format("--set {}: {} is not an item of a list of {}", path, key, node.size()));
      if (!last) next.reset(node[index]);
      if (last) node[index] = Loader::parse("v: " + override_.value, "--set " + path)["v"];
    } else {
      if (!node.IsMap() && !node.IsNull())
        throw InputError(fmt::format("--set {}: there is no section above {}", path, key));
      if (last) node[key] = Loader::parse("v: " + override_.value, "--set " + path)["v"];
      if (!last && (!node[key] || node[key].IsNull())) node[key] = YAML::Node(YAML::NodeType::Map);
      if (!last) next.reset(node[key]);
    }
    if (last) return;
    node.reset(next);
    begin = dot + 1;
  }
}

void load(YAML::Node root, const std::string& file, const fs::path& folder, const Library& library,
          const std::vector<Override>& overrides, const std::vector<fs::path>& chain,
          const std::function<void(Fields&)>& visit) {
  Loader loader(root, file, folder, library, chain);
  visit(loader);
  loader.finish();
  if (overrides.empty()) return;
  // The file is valid. What it resolves to tells the known paths; the overrides are loaded on top of it.
  Saver saver;
  visit(saver);
  YAML::Node resolved = Loader::parse(saver.finish(), file);
  std::vector<std::string> known;
  list_paths(resolved, "", known);
  for (const Override& o : overrides) {
    apply(resolved, o, known);
    Loader over(YAML::Clone(resolved), "--set " + o.path + "=" + o.value, folder, library, chain);
    visit(over);
    over.finish();
  }
}

}  // namespace

Override Override::parse(std::string_view text) {
  const size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw InputError(fmt::format("--set {}: expected key.path=value", text));
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

namespace config_detail {

void load_file(const fs::path& path, const Library& library, const std::vector<Override>& overrides,
               const std::function<void(Fields&)>& visit) {
  const YAML::Node root = Loader::parse(read_file(path, size_t{64} << 20), path.string());
  load(root, path.string(), path.parent_path(), library, overrides, {path}, visit);
}

void load_text(std::string_view yaml, const std::string& name, const Library& library,
               const std::vector<Override>& overrides, const std::function<void(Fields&)>& visit) {
  load(Loader::parse(std::string(yaml), name), name, {}, library, overrides, {}, visit);
}

std::string save(const std::function<void(Fields&)>& visit) {
  Saver saver;
  visit(saver);
  return saver.finish();
}

}  // namespace config_detail

}  // namespace vsslam
