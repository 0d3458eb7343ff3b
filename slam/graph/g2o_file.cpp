// g2o files: a line per vertex and edge, translation before rotation.
//   VERTEX_SE3:QUAT id  x y z  qx qy qz qw
//   EDGE_SE3:QUAT from to  x y z  qx qy qz qw  upper triangle of the 6 x 6 information, row by row
//   FIX id ...
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/files.h"
#include "slam/graph/pose_graph.h"

namespace vsslam {

namespace {

/// Exchanges the blocks of [rotation; translation] and [translation; rotation].
Mat6 swap_blocks(const Mat6& m) {
  Mat6 out;
  out << m.bottomRightCorner<3, 3>(), m.bottomLeftCorner<3, 3>(), m.topRightCorner<3, 3>(),
      m.topLeftCorner<3, 3>();
  return out;
}

struct Place {
  std::string file;
  int line = 0;
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file, line, message));
  }
};

std::vector<std::string_view> split(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r\f\v";
  std::vector<std::string_view> words;
  size_t begin = line.find_first_not_of(kBlank);
  while (begin != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlank, end);
  }
  return words;
}

template <class T>
T parse(std::string_view word, const char* expected, const Place& place) {
  T value{};
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  bool ok = error == std::errc{} && end == digits.data() + digits.size();
  if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(value);
  if (!ok) place.fail(fmt::format("expected {}, got \"{}\"", expected, word));
  return value;
}

int parse_id(std::string_view word, const Place& place) {
  return parse<int>(word, "a vertex id", place);
}

SE3 parse_pose(const std::vector<std::string_view>& words, size_t first, const Place& place) {
  double v[7];
  for (size_t i = 0; i < 7; ++i) v[i] = parse<double>(words[first + i], "a finite number", place);
  const Quat q(v[6], v[3], v[4], v[5]);
  const double norm = q.norm();
  if (!(norm > 1e-6) || !std::isfinite(norm))
    place.fail(fmt::format("expected a unit quaternion, got one of norm {:g}", norm));
  SE3 pose;
  // What this program has written is of unit length already and stays as it is, to the bit.
  const bool unit = std::abs(q.squaredNorm() - 1.0) < 8 * std::numeric_limits<double>::epsilon();
  pose.rotation = unit ? q : q.normalized();
  pose.translation = {v[0], v[1], v[2]};
  return pose;
}

Mat6 parse_information(const std::vector<std::string_view>& words, size_t first, const Place& place) {
  Mat6 m;
  for (int row = 0; row < 6; ++row)
    for (int col = row; col < 6; ++col)
      m(row, col) = m(col, row) = parse<double>(words[first++], "a finite number", place);
  // Scaled to a unit diagonal, so that the test does not depend on units.
  const Vec6 diagonal = m.diagonal();
  bool ok = (diagonal.array() > 0).all();
  if (ok) {
    const Vec6 scale = diagonal.cwiseSqrt().cwiseInverse();
    ok = Mat6(scale.asDiagonal() * m * scale.asDiagonal()).llt().info() == Eigen::Success;
  }
  if (!ok) place.fail("the information matrix is not positive definite");
  return swap_blocks(m);
}

class Reader {
 public:
  explicit Reader(const std::string& name) : place_{name, 0} {}

  PoseGraph read(std::string_view text) {
    while (!text.empty()) {
      const size_t end = text.find('\n');
      ++place_.line;
      read_line(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    connect();
    return std::move(graph_);
  }

 private:
  struct Fix {
    int id;
    Place place;
  };
  struct Edge {
    PoseEdge edge;
    Place place;
  };

  void read_line(std::string_view line) {
    const std::vector<std::string_view> words = split(line.substr(0, line.find('#')));
    if (words.empty()) return;
    const std::string_view tag = words[0];
    if (tag == "VERTEX_SE3:QUAT") {
      read_vertex(words);
    } else if (tag == "EDGE_SE3:QUAT") {
      read_edge(words);
    } else if (tag == "FIX") {
      if (words.size() < 2) place_.fail("FIX: expected at least one vertex id");
      for (size_t i = 1; i < words.size(); ++i) fixes_.push_back({parse_id(words[i], place_), place_});
    } else if (!tag.starts_with("PARAMS_")) {  // offsets of sensors, which no pose edge uses
      place_.fail(
          fmt::format("\"{}\" is not supported (expected VERTEX_SE3:QUAT, EDGE_SE3:QUAT or FIX)", tag));
    }
  }

  void expect_words(const std::vector<std::string_view>& words, size_t count) const {
    if (words.size() != count)
      place_.fail(fmt::format("{}: expected {} values, got {}", words[0], count - 1, words.size() - 1));
  }

  void read_vertex(const std::vector<std::string_view>& words) {
    expect_words(words, 9);
    const int id = parse_id(words[1], place_);
    if (graph_.contains(id)) place_.fail(fmt::format("vertex {} stands here twice", id));
    graph_.add_node(id, parse_pose(words, 2, place_));
  }

  void read_edge(const std::vector<std::string_view>& words) {
    expect_words(words, 31);
    PoseEdge edge;
    edge.from = parse_id(words[1], place_);
    edge.to = parse_id(words[2], place_);
    if (edge.from == edge.to) place_.fail(fmt::format("edge from vertex {} to itself", edge.from));
    edge.T_from_to = parse_pose(words, 3, place_);
    edge.information = parse_information(words, 10, place_);
    edges_.push_back({edge, place_});
  }

  /// Edges and FIX may stand before their vertices.
  void connect() {
    for (const Edge& e : edges_) {
      for (int id : {e.edge.from, e.edge.to})
        if (!graph_.contains(id)) e.place.fail(fmt::format("the edge's vertex {} does not exist", id));
      graph_.add_edge(e.edge);
    }
    for (const Fix& fix : fixes_) {
      if (!graph_.contains(fix.id)) fix.place.fail(fmt::format("FIX: vertex {} does not exist", fix.id));
      graph_.fix_node(fix.id);
    }
    if (!std::isfinite(graph_.cost()))
      throw InputError(fmt::format("{}: numbers are too large: the cost is not finite", place_.file));
  }

  Place place_;
  PoseGraph graph_;
  std::vector<Edge> edges_;
  std::vector<Fix> fixes_;
};

std::string pose_text(const SE3& pose) {
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

PoseGraph PoseGraph::parse_g2o(std::string_view text, const std::string& name) {
  return Reader(name).read(text);
}

PoseGraph PoseGraph::read_g2o(const std::filesystem::path& path) {
  return parse_g2o(read_file(path), path.string());
}

std::string PoseGraph::g2o_text() const {
  std::string out;
  for (size_t i = 0; i < ids_.size(); ++i)
    out += fmt::format("VERTEX_SE3:QUAT {} {}\n", ids_[i], pose_text(poses_[i]));
  for (int id : fixed_) out += fmt::format("FIX {}\n", id);
  for (const PoseEdge& edge : edges_) {
    out += fmt::format("EDGE_SE3:QUAT {} {} {}", edge.from, edge.to, pose_text(edge.T_from_to));
    const Mat6 information = swap_blocks(edge.information);
    for (int row = 0; row < 6; ++row)
      for (int col = row; col < 6; ++col) out += fmt::format(" {}", information(row, col));
    out += '\n';
  }
  return out;
}

void PoseGraph::write_g2o(const std::filesystem::path& path) const {
  write_file(path, g2o_text());
}

}  // namespace vsslam
