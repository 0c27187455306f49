// A host that makes the calls of rendered viewports (addon/komorebi/viewport/worker.py), without
// Blender, so that the sanitizers see them: edits, turns, resizes and pauses that come faster than
// pictures, from another thread than the one that renders. What comes when follows from a seed.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <thread>

#include "support/busy_scenes.h"

namespace komorebi::testing {
namespace {

using namespace std::chrono_literals;

/// Where one object stands, and which of its shapes it has: a new number is an edited mesh.
struct Thing {
  std::uint32_t shape = 0;
  Mat4d place{1.0};
};

/// All that a host exports of a scene.
struct Stage {
  std::vector<Thing> things{3};
  std::uint32_t map = 0;  ///< 0: a colour
  bool has_lamps = false;
  Settings settings;
};

/// Meshes that viewports share, found by their shape as in the add-on's cache.
class Shapes {
 public:
  std::shared_ptr<const Mesh> get(std::uint32_t shape, ThreadPool& pool, const Cancel& cancel) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = known_.find(shape); found != known_.end()) return found->second;
    }
    const Builder builder = shape % 2 ? Builder::kSah : Builder::kLinear;
    const auto mesh = Mesh::build(polygons(shape).input(), builder, pool, cancel);
    const std::lock_guard lock(mutex_);
    if (known_.size() > 20) known_.clear();  // scenes keep what they show
    known_[shape] = mesh;
    return mesh;
  }

 private:
  static Polygons polygons(std::uint32_t shape) {
    if (shape % 5 == 0) return quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
    if (shape % 5 == 1) return box(Vec3d(-0.4 - 0.01 * shape), Vec3d(0.5));
    return sphere(4 + static_cast<int>(shape % 37), {0, 0, 0.5}, 0.6 + 0.001 * shape,
                  shape % 3 == 0);
  }

  std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<const Mesh>> known_;
};

std::shared_ptr<const Scene> build(const Stage& stage, Shapes& shapes, const Cancel& cancel) {
  ThreadPool pool(stage.settings.threads);
  auto scene = std::make_shared<Scene>();
  for (const Thing& thing : stage.things) {
    const InstanceInput placed{scene->add_mesh(shapes.get(thing.shape, pool, cancel)), thing.place};
    scene->add_instances({&placed, 1}, "thing");
  }
  if (stage.map == 0) {
    scene->set_world_color(Vec3(0.7f));
  } else {
    const double turn = 0.3 * stage.map;
    scene->set_world_environment(gradient_map(), 0.7,
                                 Mat3d(glm::rotate(Mat4d(1.0), turn, Vec3d(0, 0, 1))));
  }
  if (stage.has_lamps) add_lamps(*scene);
  scene->commit(pool, cancel, false);
  return scene;
}

/// Renders the newest stage by the newest camera on a thread of its own, coarse pictures first.
class Viewport {
 public:
  explicit Viewport(Shapes& shapes) : shapes_(shapes), thread_([this] { run(); }) {}
  ~Viewport() {
    change([&] { stopped_ = true; });
    thread_.join();
  }

  void show(const Stage& stage) {
    change([&] { stage_ = stage; });
  }
  void look(const CameraDesc& camera) {
    change([&] { camera_ = camera; });
  }
  void pause(bool paused) {
    const std::lock_guard lock(mutex_);
    paused_ = paused;
    changed_condition_.notify_all();
  }
  /// What a host draws by, from a thread that does not render.
  void draw() {
    std::shared_ptr<Session> session;
    {
      const std::lock_guard lock(mutex_);
      session = session_;
    }
    if (session) read(*session);
  }
  /// The picture when nothing is left to do.
  std::vector<float> finished() {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_condition_.wait_for(lock, 240s, [&] { return idle_ && !changed_; }));
    return picture_;
  }

 private:
  template <class Set>
  void change(const Set& set) {
    const std::lock_guard lock(mutex_);
    set();
    changed_ = true;
    if (cancel_) cancel_->raise();
    changed_condition_.notify_all();
  }
  bool is_over() {
    const std::lock_guard lock(mutex_);
    return changed_;
  }

  void run() {
    std::shared_ptr<const Scene> scene;
    Settings settings;
    while (true) {
      std::optional<Stage> stage;
      std::optional<CameraDesc> camera;
      const auto cancel = std::make_shared<Cancel>();
      {
        std::unique_lock lock(mutex_);
        idle_ = true;
        changed_condition_.notify_all();
        changed_condition_.wait(lock, [&] { return changed_; });
        if (stopped_) return;
        idle_ = changed_ = false;
        std::swap(stage, stage_);
        camera = camera_;
        cancel_ = cancel;
      }
      try {
        if (stage) {
          scene = build(*stage, shapes_, *cancel);
          settings = stage->settings;
        }
      } catch (const Cancelled&) {
        const std::lock_guard lock(mutex_);
        if (!stage_) stage_ = stage;  // it comes again, unless there is a newer one
        changed_ = true;
        continue;
      }
      if (!scene || !camera) continue;
      for (const std::uint32_t pixel : {8u, 4u, 1u}) {
        if (!render(scene, settings, *camera, pixel)) break;
      }
    }
  }

  bool render(const std::shared_ptr<const Scene>& scene, Settings settings, CameraDesc camera,
              std::uint32_t pixel) {
    camera.width = (camera.width + pixel - 1) / pixel;
    camera.height = (camera.height + pixel - 1) / pixel;
    if (pixel > 1) {
      settings.samples = 1;
      settings.guides_light = settings.use_adaptive_sampling = false;
    }
    const auto session = std::make_shared<Session>(scene, settings, camera);
    {
      const std::lock_guard lock(mutex_);
      session_ = session;
    }
    std::uint32_t sample = 0;
    while (true) {
      const bool over = session->wait(0.002);
      if (is_over()) return false;
      EXPECT_EQ(session->error(), "");
      if (const auto now = session->progress().sample; over || now > sample) {
        sample = now;
        std::vector<float> picture = read(*session);
        const std::lock_guard lock(mutex_);
        picture_ = std::move(picture);
      }
      if (over) return true;
      if (is_paused()) {
        session->cancel();
        EXPECT_TRUE(session->wait(60.0));
        std::unique_lock lock(mutex_);
        changed_condition_.wait(lock, [&] { return changed_ || !paused_; });
        lock.unlock();
        session->resume();
      }
    }
  }
  bool is_paused() {
    const std::lock_guard lock(mutex_);
    return paused_;
  }

  static std::vector<float> read(Session& session) {
    const Rect region = session.settings().region;
    std::vector<float> picture(4 * region.area());
    session.read("Combined", region, picture.data());
    session.progress();
    return picture;
  }

  Shapes& shapes_;
  std::mutex mutex_;  // guards all below but the thread
  std::condition_variable changed_condition_;
  std::optional<Stage> stage_;  // not taken yet
  std::optional<CameraDesc> camera_;
  std::shared_ptr<Cancel> cancel_;
  std::shared_ptr<Session> session_;
  std::vector<float> picture_;
  bool changed_ = false, paused_ = false, stopped_ = false, idle_ = false;
  std::thread thread_;  // last: it begins when all else is there
};

/// Random actions of a host with three viewports on one scene.
class Host {
 public:
  explicit Host(unsigned seed) : random_(seed) {
    stage_.things = {{0, Mat4d(1.0)}, {1, moved(0.6)}, {2, moved(-0.7)}};
    stage_.settings = small_settings(Method::kAmbientOcclusion);
    stage_.settings.passes = {"Combined"};
    for (Seat& seat : seats_) open(seat);
  }

  void act() {
    Seat& seat = seats_[below(3)];
    const std::uint32_t action = below(12);
    switch (action) {
      case 0:
        turn_settings();
        break;
      case 1:
        stage_.map = below(3);
        break;
      case 2:
        stage_.has_lamps = !stage_.has_lamps;
        break;
      case 3:
        stage_.things[below(3)].shape = below(200);
        break;
      case 4:
        stage_.things[1 + below(2)].place = moved(0.01 * below(200) - 1.0);
        break;
      case 5: {
        const Thing another{below(200), moved(0.01 * below(200))};
        if (stage_.things.size() < 6) stage_.things.push_back(another);
        break;
      }
      case 6:
        seat.viewport->pause(true);
        break;
      case 7:
        seat.viewport->pause(false);
        break;
      case 8:
        open(seat);
        break;  // closes the one that was there, whatever it does
      case 9:
        seat.viewport->draw();
        break;
      default:
        look(seat);
    }
    if (action < 6) {  // an edit reaches all viewports
      for (Seat& each : seats_) each.viewport->show(stage_);
    }
    if (below(3) == 0) std::this_thread::sleep_for(1ms * below(40));
  }

  /// Whatever went before, each shows what a render from nothing shows.
  void expect_right_pictures() {
    for (Seat& seat : seats_) seat.viewport->pause(false);
    for (Seat& seat : seats_) {
      const std::vector<float> shown = seat.viewport->finished();
      Shapes fresh;
      Session session(build(stage_, fresh, Cancel()), stage_.settings, seat.camera);
      ASSERT_TRUE(session.wait(240.0));
      std::vector<float> expected(4 * session.settings().region.area());
      session.read("Combined", session.settings().region, expected.data());
      EXPECT_TRUE(shown == expected);
    }
  }

 private:
  struct Seat {
    std::unique_ptr<Viewport> viewport;
    CameraDesc camera;
  };

  std::uint32_t below(std::uint32_t end) {
    return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random_);
  }
  static Mat4d moved(double x) { return glm::translate(Mat4d(1.0), Vec3d(x, 0.3 * x, 0.2)); }

  void open(Seat& seat) {
    seat.viewport = std::make_unique<Viewport>(shapes_);
    look(seat);
    seat.viewport->show(stage_);
  }
  void look(Seat& seat) {
    const Vec3d eye(0.1 * below(60) - 3.0, -4.0, 1.0 + 0.1 * below(30));
    const bool tiny = below(8) == 0;
    const auto side = [&](std::uint32_t most) {
      return tiny ? 1 + below(3) : most / 2 + below(most / 2);
    };
    seat.camera = camera_at(eye, {0, 0, 0.5}, side(64), side(48));
    if (below(4) == 0) seat.camera.lens = {0.1, 6, 0.2, 1.0, 4.0};
    if (below(5) == 0) {
      seat.camera.kind = CameraKind::kPanorama;
      seat.camera.world_from_camera[3] = glm::dvec4(eye, 1.0);
      seat.camera.panorama.kind = PanoramaKind::kFisheyeEquidistant;
      seat.camera.panorama.fov = 3.0;
    }
    seat.viewport->look(seat.camera);
  }
  void turn_settings() {
    Settings& s = stage_.settings;
    s.method = below(2) ? Method::kWorldLight : Method::kAmbientOcclusion;
    s.samples = 1 + below(6);
    s.bounces = below(3);
    s.threads = below(4);
    s.use_adaptive_sampling = below(2) == 0;
    s.film_transparent = below(2) == 0;
  }

  std::mt19937 random_;
  Shapes shapes_;
  Stage stage_;
  Seat seats_[3];
};

/// KOMOREBI_REPLAY_ACTIONS and KOMOREBI_REPLAY_SEED: a longer or another replay.
int number_of(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

TEST(ViewportReplay, EndsWithTheRightPicturesWhateverWentBefore) {
  const int first = number_of("KOMOREBI_REPLAY_SEED", 1);
  const int actions = number_of("KOMOREBI_REPLAY_ACTIONS", 60);
  for (int seed = first; seed < first + 3; ++seed) {
    SCOPED_TRACE("KOMOREBI_REPLAY_SEED=" + std::to_string(seed));
    Host host(static_cast<unsigned>(seed));
    for (int i = 0; i < actions; ++i) {
      host.act();
      if (i % 20 == 19) host.expect_right_pictures();
    }
    host.expect_right_pictures();
  }
}

}  // namespace
}  // namespace komorebi::testing
