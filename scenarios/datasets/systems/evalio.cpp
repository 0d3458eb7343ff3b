// evalio (Potokar et al.), github.com/contagon/evalio: a Python class that describes the dataset. Names: its
// python/evalio/datasets/{base,loaders}.py and the datasets beside them.
#include <fmt/format.h>

#include <cmath>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/target_configurations.h"
#include "sensors/lidar/laser_table.h"

namespace vsslam {

namespace {

std::string mat_text(const SE3& T) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string rows;
  for (int r = 0; r < 4; ++r) rows += fmt::format("[{}, {}, {}, {}], ", m(r, 0), m(r, 1), m(r, 2), m(r, 3));
  return fmt::format("SE3.fromMat(np.array([{}]))", rows.substr(0, rows.size() - 2));
}

// Firing cycles of a turn, and a few to spare: the motor turns unevenly.
int columns(const LidarConfig& lidar) {
  const double cycle_s = 1e-9 * static_cast<double>(laser_table(lidar.model).cycle_ns);
  return static_cast<int>(std::ceil(1 / (lidar.rate_hz * cycle_s))) + 8;
}

constexpr const char* kClass =
    R"(# Tells evalio of this dataset. Numbers are those of the simulated rig.
from enum import auto
from pathlib import Path

import numpy as np
from evalio.datasets.base import Dataset, DatasetIterator
from evalio.datasets.loaders import LidarDensity, LidarFormatParams, LidarMajor, LidarPointStamp, LidarStamp, RosbagIter
from evalio.types import SE3, ImuParams, LidarParams, Trajectory

HERE = Path(__file__).resolve().parent


def columns_by_time(scan):
    """The column is the firing cycle."""
    for point in scan.points:
        point.col = int(point.t.to_sec() / {cycle_s} + 0.01)


class VsslamDataset(Dataset):
    """Simulated by the VS-SLAM Testbed; the truth is exact."""

    {sequence} = auto()

    def data_iter(self) -> DatasetIterator:
        return RosbagIter(
            HERE / "{bag}.bag",
            "{points}",
            "{imu}",
            self.lidar_params(),
            lidar_format=LidarFormatParams(
                stamp=LidarStamp.Start,
                point_stamp=LidarPointStamp.Start,
                major=LidarMajor.Column,
                density=LidarDensity.OnlyValidPoints,
            ),
            custom_col_func=columns_by_time,
        )

    def ground_truth_raw(self) -> Trajectory:
        columns = ["sec", "x", "y", "z", "qx", "qy", "qz", "qw"]
        return Trajectory.from_csv(HERE / "truth.tum", columns, delimiter=" ")

    def imu_T_lidar(self) -> SE3:
        return {imu_lidar}

    def imu_T_gt(self) -> SE3:
        return {imu_base}  # the truth is of the base

    def imu_params(self) -> ImuParams:
        # Continuous-time densities.
        return ImuParams(
            gyro={gyro},
            accel={accel},
            gyro_bias={gyro_bias},
            accel_bias={accel_bias},
            bias_init=1e-7,
            integration=1e-7,
            gravity=np.array([0, 0, -{gravity}]),
            brand="simulated",
            model="simulated",
        )

    def lidar_params(self) -> LidarParams:
        return LidarParams(
            num_rows={rows},
            num_columns={columns},
            min_range={min_range},
            max_range={max_range},
            brand="Velodyne",
            model="{model}",
        )

    @staticmethod
    def url() -> str:
        return "simulated"

    def environment(self) -> str:
        return "simulated"

    def vehicle(self) -> str:
        return "AgileX Scout 2.0"

    def files(self):
        return [str(HERE / "{bag}.bag"), str(HERE / "truth.tum")]
)";

std::string class_text(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  const LidarCalibration& lidar = facts.rig.lidar;
  const bool vlp16 = facts.scenario.rig.sensors.lidar.model == LidarModel::vlp16;
  const SE3 T_imu_base = imu.T_base_imu.inverse();
  return fmt::format(
      kClass,
      fmt::arg("cycle_s",
               1e-9 * static_cast<double>(laser_table(facts.scenario.rig.sensors.lidar.model).cycle_ns)),
      fmt::arg("sequence", "sequence"), fmt::arg("bag", facts.scenario.name),
      fmt::arg("points", facts.names.points), fmt::arg("imu", facts.names.imu),
      fmt::arg("imu_lidar", mat_text(T_imu_base * lidar.T_base_lidar)),
      fmt::arg("imu_base", mat_text(T_imu_base)), fmt::arg("gyro", imu.gyro_noise_radps_rthz),
      fmt::arg("accel", imu.accel_noise_mps2_rthz), fmt::arg("gyro_bias", imu.gyro_bias_walk_radps2_rthz),
      fmt::arg("accel_bias", imu.accel_bias_walk_mps3_rthz), fmt::arg("gravity", imu.gravity_mps2),
      fmt::arg("rows", lidar.rings), fmt::arg("columns", columns(facts.scenario.rig.sensors.lidar)),
      fmt::arg("min_range", lidar.min_range_m), fmt::arg("max_range", lidar.max_range_m),
      fmt::arg("model", vlp16 ? "VLP-16" : "VLP-32C"));
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {{"vsslam_dataset.py", class_text(facts)}};
}

std::string instructions(const DatasetFacts&) {
  return "    pip install evalio\n"
         "    PYTHONPATH=. EVALIO_CUSTOM=vsslam_dataset evalio ls datasets\n"
         "    PYTHONPATH=. EVALIO_CUSTOM=vsslam_dataset evalio run -d vsslam_dataset/sequence -p kiss -o "
         "results\n";
}

}  // namespace

TargetSystem evalio() {
  return {"evalio", "evalio", DatasetFormat::bag, false, false, {}, configuration, instructions};
}

}  // namespace vsslam
