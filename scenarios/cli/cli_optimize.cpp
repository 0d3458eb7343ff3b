#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/cli/cli.h"
#include "slam/graph/pose_graph.h"

namespace vsslam {

namespace {

struct OptimizeArguments {
  std::string file, out;
};

int optimize(const OptimizeArguments& arguments, const Console& console) {
  PoseGraph graph = PoseGraph::read_g2o(arguments.file);
  const PoseGraph::Summary s = graph.optimize({});
  if (!arguments.out.empty()) graph.write_g2o(arguments.out);
  console.text() << fmt::format(
      "{} poses, {} edges\ninitial cost {:.9g}\nfinal cost   {:.9g}  ({} iterations, {})\n",
      graph.ids().size(), graph.edges().size(), s.initial_cost, s.final_cost, s.iterations,
      s.converged ? "converged" : "not converged");
  if (console.json) {
    const nlohmann::ordered_json json = {{"poses", graph.ids().size()},
                                         {"edges", graph.edges().size()},
                                         {"initial_cost", s.initial_cost},
                                         {"final_cost", s.final_cost}};
    console.out << json.dump(2) << '\n';
  }
  return kDone;
}

}  // namespace

void add_optimize_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand("optimize", "optimise a pose graph of a g2o file and print its costs");
  const auto arguments = std::make_shared<OptimizeArguments>();
  sub->add_option("file", arguments->file, "a g2o file (VERTEX_SE3:QUAT, EDGE_SE3:QUAT)")->required();
  sub->add_option("--out", arguments->out, "write the optimised graph to this g2o file");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return optimize(*arguments, console); };
  });
}

}  // namespace vsslam
