#include "sim/dynamics.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <btBulletDynamicsCommon.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace vsslam {

namespace {

constexpr double kMeshMargin_m = 0.001;
// Collision groups: wheel i meets only its own floor plane, the outline only meshes.
constexpr int wheel_bit(int wheel) {
  return 1 << wheel;
}
constexpr int plane_bit(int wheel) {
  return 1 << (4 + wheel);
}
constexpr int kOutlineBit = 1 << 8, kMeshBit = 1 << 9;

btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 to_eigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btTransform to_bullet(const Quat& q, const Vec3& t) {
  return btTransform({q.x(), q.y(), q.z(), q.w()}, to_bullet(t));
}
Quat to_eigen(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

// A placement as a rigid motion of a mesh that was scaled before: linear = rotation * stretch.
struct Placement {
  Mat3 stretch;
  btTransform T_world_object;
  explicit Placement(const Eigen::Affine3d& T) {
    Mat3 rotation, scaling;
    T.computeRotationScaling(&rotation, &scaling);
    stretch = scaling;
    T_world_object = to_bullet(Quat(rotation), T.translation());
  }
};

// The world's meshes as static bodies. Shapes are shared where objects share a mesh and its scale. Bullet visits
// all bodies in each step, so it knows only those near the robot.
class Obstacles {
 public:
  Obstacles(const World& world, btDiscreteDynamicsWorld& dynamics) : dynamics_(dynamics) {
    bodies_.resize(world.objects.size());
    for (size_t i = 0; i < world.objects.size(); ++i) {
      const Object& object = world.objects[i];
      if (object.collision == Collision::none) continue;
      const Placement placement(object.T_world_object);
      btCollisionShape* shape = shape_of(world, object.mesh, placement.stretch);
      if (!shape) continue;
      Body& body = bodies_[i];
      body.bullet = std::make_unique<btRigidBody>(0.0, nullptr, shape);
      body.bullet->setWorldTransform(placement.T_world_object);
      body.bullet->setFriction(0.3);
      body.bullet->setUserIndex(static_cast<int>(i));
      body.exists = true;
    }
  }
  ~Obstacles() {
    for (Body& body : bodies_) make_known(body, false);
  }
  Obstacles(const Obstacles&) = delete;
  Obstacles& operator=(const Obstacles&) = delete;

  void place(int object, const Eigen::Affine3d& T_world_object, bool present) {
    Body& body = bodies_.at(static_cast<size_t>(object));
    if (!body.bullet) return;
    make_known(body, false);  // Bullet expects static bodies to stay
    body.bullet->setWorldTransform(Placement(T_world_object).T_world_object);
    body.exists = present;
    if (robot_world_) choose(body);
  }

  /// To be called before each step: the bodies around the robot become known to Bullet, those left behind unknown.
  void follow(const Vec3& robot_world) {
    constexpr double kStride_m = 1.0;  // how far the robot may move before they are looked at anew
    if (robot_world_ && (robot_world - *robot_world_).squaredNorm() < kStride_m * kStride_m) return;
    robot_world_ = robot_world;
    for (Body& body : bodies_) choose(body);
  }

 private:
  struct Body {
    std::unique_ptr<btRigidBody> bullet;  // none: never collides
    bool exists = false;                  // in the world at this time
    bool known = false;                   // to Bullet
  };
  struct Shape {
    int mesh;
    Mat3 stretch;
    std::unique_ptr<btTriangleMesh> triangles;
    std::unique_ptr<btBvhTriangleMeshShape> bullet;
  };

  void choose(Body& body) { make_known(body, body.exists && near(*body.bullet, *robot_world_)); }

  void make_known(Body& body, bool known) {
    if (known && !body.known) dynamics_.addRigidBody(body.bullet.get(), kMeshBit, kOutlineBit);
    if (!known && body.known) dynamics_.removeRigidBody(body.bullet.get());
    body.known = known;
  }

  static bool near(const btRigidBody& body, const Vec3& robot_world) {
    constexpr double kNear_m = 5.0;  // the robot's reach, a stride and more
    btVector3 low, high;
    body.getCollisionShape()->getAabb(body.getWorldTransform(), low, high);
    const Vec3 outside =
        (to_eigen(low) - robot_world).cwiseMax(robot_world - to_eigen(high)).cwiseMax(Vec3::Zero());
    return outside.squaredNorm() < kNear_m * kNear_m;
  }

  btCollisionShape* shape_of(const World& world, int mesh, const Mat3& stretch) {
    const auto [first, last] = shapes_of_mesh_.equal_range(mesh);
    for (auto it = first; it != last; ++it)
      if ((it->second.stretch - stretch).norm() < 1e-6) return it->second.bullet.get();
    Shape shape{mesh, stretch, std::make_unique<btTriangleMesh>(), nullptr};
    for (const Primitive& primitive : world.meshes[static_cast<size_t>(mesh)].primitives)
      for (const auto& triangle : primitive.triangles) {
        std::array<btVector3, 3> corners;
        for (size_t k = 0; k < 3; ++k)
          corners[k] = to_bullet(stretch * primitive.positions[triangle[k]].cast<double>());
        shape.triangles->addTriangle(corners[0], corners[1], corners[2]);
      }
    if (shape.triangles->getNumTriangles() == 0) return nullptr;
    shape.bullet = std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true);
    shape.bullet->setMargin(kMeshMargin_m);
    return shapes_of_mesh_.emplace(mesh, std::move(shape))->second.bullet.get();
  }

  btDiscreteDynamicsWorld& dynamics_;
  std::multimap<int, Shape> shapes_of_mesh_;
  std::vector<Body> bodies_;         // one per object of the world
  std::optional<Vec3> robot_world_;  // where the known bodies were last chosen
};

}  // namespace

struct Dynamics::Impl {
  Impl(const World& world, const ScoutConfig& config, double x_m, double y_m, double yaw_rad)
      : scout(config), floor(world.floor), outline(make_outline()), wheel_shape(config.wheel_radius_m) {
    set_up_solver();
    obstacles = std::make_unique<Obstacles>(world, bullet);
    add_chassis(x_m, y_m, yaw_rad);
    for (int i = 0; i < 4; ++i) add_wheel(i);
    read_state();
  }
  ~Impl() {
    for (WheelBody& wheel : wheels) {
      bullet.removeConstraint(wheel.hinge.get());
      bullet.removeRigidBody(wheel.body.get());
      bullet.removeRigidBody(wheel.floor.get());
    }
    bullet.removeRigidBody(chassis.get());
    obstacles.reset();
  }

  struct WheelBody {
    std::unique_ptr<btRigidBody> body, floor;
    std::unique_ptr<btHingeConstraint> hinge;
    Vec3 up_world = Vec3::UnitZ();  // the floor's normal at the contact
    double friction = -1;
    double last_angle_rad = 0;  // of the hinge, in (-pi, pi]
  };

  void set_up_solver() {
    bullet.setGravity({0, 0, -kGravity_mps2});
    bullet.setForceUpdateAllAabbs(false);
    btContactSolverInfo& info = bullet.getSolverInfo();
    info.m_numIterations = 8;
    info.m_splitImpulse = false;  // the tyres are springs: there is no penetration to push out
    // One friction direction, along the slip: a sliding contact brakes with mu N exactly against its motion.
    // Without warm starts, which would carry last step's friction into a direction that has turned since.
    info.m_solverMode = 0;
  }

  std::unique_ptr<btCompoundShape> make_outline() {
    const double top_m = 0.5 * scout.chassis_size_m.z(),
                 bottom_m = Dynamics::kStepOver_m - base_height_m(scout);
    outline_box = std::make_unique<btBoxShape>(
        btVector3(0.5 * scout.hull_length_m, 0.5 * scout.hull_width_m, 0.5 * (top_m - bottom_m)));
    auto compound = std::make_unique<btCompoundShape>(true, 1);
    compound->addChildShape(to_bullet(Quat::Identity(), {0, 0, 0.5 * (top_m + bottom_m)}), outline_box.get());
    return compound;
  }

  void add_chassis(double x_m, double y_m, double yaw_rad) {
    const Vec3 up_world = floor.normal(x_m, y_m);
    const Quat q_world_base = Quat::FromTwoVectors(Vec3::UnitZ(), up_world) * so3_exp({0, 0, yaw_rad});
    const Vec3 p_world = Vec3(x_m, y_m, floor.height(x_m, y_m)) + base_height_m(scout) * up_world;
    chassis = std::make_unique<btRigidBody>(scout.chassis_mass_kg + scout.payload_kg, nullptr, outline.get(),
                                            to_bullet(scout.chassis_inertia_kgm2));
    chassis->setFriction(0.3);
    add_body(*chassis, to_bullet(q_world_base, p_world), kOutlineBit, kMeshBit);
  }

  void add_wheel(int i) {
    WheelBody& wheel = wheels[static_cast<size_t>(i)];
    const double m = scout.wheel_mass_kg, r = scout.wheel_radius_m, w = scout.wheel_width_m;
    const double across = m * (3 * r * r + w * w) / 12;
    wheel.body =
        std::make_unique<btRigidBody>(m, nullptr, &wheel_shape, btVector3(across, 0.5 * m * r * r, across));
    const btTransform T_base_wheel = to_bullet(Quat::Identity(), wheel_position_base(i));
    add_body(*wheel.body, chassis->getWorldTransform() * T_base_wheel, wheel_bit(i), plane_bit(i));
    const btVector3 axle(0, 1, 0);
    wheel.hinge = std::make_unique<btHingeConstraint>(*chassis, *wheel.body, T_base_wheel.getOrigin(),
                                                      btVector3(0, 0, 0), axle, axle, true);
    wheel.body->setContactStiffnessAndDamping(scout.tyre_stiffness_npm, scout.tyre_damping_nspm);
    wheel.hinge->setUseFrameOffset(false);
    bullet.addConstraint(wheel.hinge.get(), true);
    wheel.floor = std::make_unique<btRigidBody>(0.0, nullptr, &plane_shape);
    wheel.floor->setFriction(1.0);
    bullet.addRigidBody(wheel.floor.get(), plane_bit(i), wheel_bit(i));
    lay_floor(wheel);
  }

  void add_body(btRigidBody& body, const btTransform& T_world_body, int group, int mask) {
    body.setWorldTransform(T_world_body);
    body.setInterpolationWorldTransform(T_world_body);
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setDamping(0, 0);
    bullet.addRigidBody(&body, group, mask);
  }

  Vec3 wheel_position_base(int i) const {
    const double forward = i == kFrontLeft || i == kFrontRight ? 0.5 : -0.5;
    const double left = i == kFrontLeft || i == kRearLeft ? 0.5 : -0.5;
    return {forward * scout.wheelbase_m, left * scout.track_m, -scout.axle_below_base_m};
  }

  // The plane that touches the floor where the wheel does. Where that is, last step's normal tells.
  void lay_floor(WheelBody& wheel) {
    const Vec3 below =
        to_eigen(wheel.body->getWorldTransform().getOrigin()) - scout.wheel_radius_m * wheel.up_world;
    const Vec3 contact_world(below.x(), below.y(), floor.height(below.x(), below.y()));
    wheel.up_world = floor.normal(below.x(), below.y());
    wheel.floor->setWorldTransform(
        to_bullet(Quat::FromTwoVectors(Vec3::UnitZ(), wheel.up_world), contact_world));
  }

  void drive(int i, double radps, double friction_scale) {
    WheelBody& wheel = wheels[static_cast<size_t>(i)];
    wheel.hinge->enableAngularMotor(true, radps, scout.wheel_torque_limit_nm * kStep_s);
    const double friction = scout.friction * friction_scale;
    if (friction != wheel.friction) wheel.body->setFriction(wheel.friction = friction);
    if (floor.unevenness_m > 0) lay_floor(wheel);
  }

  void read_state() {
    const btTransform& T = chassis->getWorldTransform();
    state.T_world_base = SE3(to_eigen(T.getRotation()), to_eigen(T.getOrigin()));
    state.v_world = to_eigen(chassis->getLinearVelocity());
    state.omega_world = to_eigen(chassis->getAngularVelocity());
    for (int i = 0; i < 4; ++i) read_wheel(i);
  }

  void read_wheel(int i) {
    const size_t k = static_cast<size_t>(i);
    const Quat& q_world_base = state.T_world_base.rotation;
    const Quat q_base_wheel =
        q_world_base.conjugate() * to_eigen(wheels[k].body->getWorldTransform().getRotation());
    const double angle_rad = 2 * std::atan2(q_base_wheel.y(), q_base_wheel.w());
    state.wheel_rad[k] += std::remainder(angle_rad - wheels[k].last_angle_rad, 2 * M_PI);
    wheels[k].last_angle_rad = angle_rad;
    const Vec3 omega_world = to_eigen(wheels[k].body->getAngularVelocity()) - state.omega_world;
    state.wheel_radps[k] = (q_world_base.conjugate() * omega_world).y();
    const Vec3 v_base = q_world_base.conjugate() * state.v_world,
               omega_base = q_world_base.conjugate() * state.omega_world;
    const double ground_mps = v_base.x() - omega_base.z() * wheel_position_base(i).y();
    state.slip_mps[k] = scout.wheel_radius_m * state.wheel_radps[k] - ground_mps;
  }

  // Stiction: what has all but stood for a while without being driven stands, until it is driven or the floor
  // changes. The solver's few iterations would let it creep by 0.1 mm/s.
  bool stands(const Sides& wheel_radps, const Sides& friction_scale) {
    constexpr int kSteps = 100;
    constexpr double kSlow_mps = 2e-3, kSlow_radps = 4e-3;
    const bool same_floor = friction_scale == last_friction_scale;
    last_friction_scale = friction_scale;
    bool slow = same_floor && wheel_radps == Sides{} && state.v_world.norm() < kSlow_mps &&
                state.omega_world.norm() < kSlow_radps;
    for (const double radps : state.wheel_radps) slow = slow && std::abs(radps) < 5 * kSlow_radps;
    still_steps = slow ? still_steps + 1 : 0;
    if (still_steps == kSteps) stop();
    return still_steps >= kSteps;
  }

  void stop() {
    const auto stop_body = [](btRigidBody& body) {
      body.setLinearVelocity({0, 0, 0});
      body.setAngularVelocity({0, 0, 0});
    };
    stop_body(*chassis);
    for (WheelBody& wheel : wheels) stop_body(*wheel.body);
    read_state();
  }

  void find_touched() {
    touched = -1;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
      const btCollisionObject *a = manifold.getBody0(), *b = manifold.getBody1();
      if (a != chassis.get() && b != chassis.get()) continue;
      for (int k = 0; k < manifold.getNumContacts(); ++k)
        if (manifold.getContactPoint(k).getDistance() <= 0)
          touched = (a == chassis.get() ? b : a)->getUserIndex();
    }
  }

  static constexpr double kStep_s = 1e-9 * static_cast<double>(kStep_ns);
  const ScoutConfig scout;
  const Floor floor;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld bullet{&dispatcher, &broadphase, &solver, &configuration};
  std::unique_ptr<btBoxShape> outline_box;
  std::unique_ptr<btCompoundShape> outline;
  btSphereShape wheel_shape;
  btStaticPlaneShape plane_shape{btVector3(0, 0, 1), 0};
  std::unique_ptr<Obstacles> obstacles;
  std::unique_ptr<btRigidBody> chassis;
  std::array<WheelBody, 4> wheels;
  RobotState state;
  int touched = -1;
  int still_steps = 0;
  Sides last_friction_scale{1, 1};
};

Dynamics::Dynamics(const World& world, const ScoutConfig& scout, double x_m, double y_m, double yaw_rad)
    : impl_(std::make_unique<Impl>(world, scout, x_m, y_m, yaw_rad)) {}
Dynamics::~Dynamics() = default;

void Dynamics::step(const Sides& wheel_radps, const Sides& friction_scale) {
  if (impl_->stands(wheel_radps, friction_scale)) return;
  for (int i : {kFrontLeft, kRearLeft}) impl_->drive(i, wheel_radps.left, friction_scale.left);
  for (int i : {kFrontRight, kRearRight}) impl_->drive(i, wheel_radps.right, friction_scale.right);
  impl_->obstacles->follow(impl_->state.T_world_base.translation);
  impl_->bullet.stepSimulation(Impl::kStep_s, 0);
  impl_->read_state();
  impl_->find_touched();
}

const RobotState& Dynamics::state() const {
  return impl_->state;
}

int Dynamics::touched_object() const {
  return impl_->touched;
}

void Dynamics::set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present) {
  impl_->obstacles->place(object, T_world_object, present);
  impl_->still_steps = 0;
}

}  // namespace vsslam
