#include <pybind11/stl.h>

#include <array>
#include <optional>

#include "python/arrays.h"
#include "python/bind.h"
#include "render/dump.h"
#include "render/session.h"

namespace komorebi::python {
namespace {

template <class Enum>
struct Choice {
  const char* name;
  Enum value;
};

constexpr Choice<Method> kMethods[] = {{"AMBIENT_OCCLUSION", Method::kAmbientOcclusion},
                                       {"WORLD_LIGHT", Method::kWorldLight}};
constexpr Choice<AoSampling> kAoSamplings[] = {{"COSINE", AoSampling::kCosine},
                                               {"UNIFORM", AoSampling::kUniform}};
constexpr Choice<EnvironmentSampling> kEnvironmentSamplings[] = {
    {"MIS", EnvironmentSampling::kMis},
    {"COSINE", EnvironmentSampling::kCosine},
    {"ENVIRONMENT", EnvironmentSampling::kEnvironment},
    {"PRODUCT", EnvironmentSampling::kProduct}};
constexpr Choice<FastGiMethod> kFastGiMethods[] = {{"REPLACE", FastGiMethod::kReplace},
                                                   {"ADD", FastGiMethod::kAdd}};
constexpr Choice<PixelFilter> kPixelFilters[] = {{"BLACKMAN_HARRIS", PixelFilter::kBlackmanHarris},
                                                 {"GAUSSIAN", PixelFilter::kGaussian},
                                                 {"BOX", PixelFilter::kBox}};

template <class Enum, std::size_t N>
Enum parse(const char* setting, const std::string& name, const Choice<Enum> (&choices)[N]) {
  std::string known;
  for (const auto& choice : choices) {
    if (name == choice.name) return choice.value;
    known += (known.empty() ? "" : ", ") + std::string(choice.name);
  }
  throw std::invalid_argument(std::string(setting) + " must be one of " + known + ", not " + name);
}

constexpr Choice<MistFalloff> kMistFalloffs[] = {
    {"QUADRATIC", MistFalloff::kQuadratic},
    {"LINEAR", MistFalloff::kLinear},
    {"INVERSE_QUADRATIC", MistFalloff::kInverseQuadratic}};

using Region = std::array<std::uint32_t, 4>;

std::shared_ptr<Settings> make_settings(
    const std::string& method, std::uint32_t samples, std::uint32_t light_samples,
    std::uint32_t sample_offset, std::uint32_t seed, bool use_adaptive_sampling,
    float adaptive_threshold, std::uint32_t adaptive_min_samples, float time_limit,
    float ao_distance, const std::string& ao_sampling, const std::array<float, 3>& clay_color,
    std::uint32_t bounces, float sample_clamp_direct, float sample_clamp_indirect,
    std::uint32_t world_max_bounces, bool use_fast_gi, const std::string& fast_gi_method,
    std::uint32_t fast_gi_bounces, float fast_gi_distance, float fast_gi_factor,
    const std::string& environment_sampling, const std::string& pixel_filter, float filter_width,
    bool use_progressive, bool film_transparent, float mist_start, float mist_depth,
    const std::string& mist_falloff, std::uint32_t threads, std::uint32_t tile_size,
    const std::optional<Region>& region, const std::vector<std::string>& passes, bool guides_light,
    bool has_low_priority, std::uint32_t samples_per_pass) {
  auto s = std::make_shared<Settings>();
  s->method = parse("method", method, kMethods);
  s->samples = samples;
  s->light_samples = light_samples;
  s->sample_offset = sample_offset;
  s->seed = seed;
  s->use_adaptive_sampling = use_adaptive_sampling;
  s->adaptive_threshold = adaptive_threshold;
  s->adaptive_min_samples = adaptive_min_samples;
  s->time_limit = time_limit;
  s->ao_distance = ao_distance;
  s->ao_sampling = parse("ao_sampling", ao_sampling, kAoSamplings);
  s->clay_color = Vec3(clay_color[0], clay_color[1], clay_color[2]);
  s->bounces = bounces;
  s->sample_clamp_direct = sample_clamp_direct;
  s->sample_clamp_indirect = sample_clamp_indirect;
  s->world_max_bounces = world_max_bounces;
  s->use_fast_gi = use_fast_gi;
  s->fast_gi_method = parse("fast_gi_method", fast_gi_method, kFastGiMethods);
  s->fast_gi_bounces = fast_gi_bounces;
  s->fast_gi_distance = fast_gi_distance;
  s->fast_gi_factor = fast_gi_factor;
  s->environment_sampling =
      parse("environment_sampling", environment_sampling, kEnvironmentSamplings);
  s->pixel_filter = parse("pixel_filter", pixel_filter, kPixelFilters);
  s->filter_width = filter_width;
  s->use_progressive = use_progressive;
  s->film_transparent = film_transparent;
  s->mist_start = mist_start;
  s->mist_depth = mist_depth;
  s->mist_falloff = parse("mist_falloff", mist_falloff, kMistFalloffs);
  s->threads = threads;
  s->tile_size = tile_size;
  s->has_region = region.has_value();
  if (region) s->region = {(*region)[0], (*region)[1], (*region)[2], (*region)[3]};
  s->passes = passes;
  s->guides_light = guides_light;
  s->has_low_priority = has_low_priority;
  s->samples_per_pass = samples_per_pass;
  return s;
}

/// Rectangles go in and out of Python relative to the rendered region, as Blender's results are.
using PyRect = std::array<std::uint32_t, 4>;  // x, y, width, height

std::vector<PyRect> updated_tiles(Session& session) {
  const Rect& region = session.settings().region;
  std::vector<PyRect> tiles;
  for (const Rect& t : session.updated_tiles()) {
    tiles.push_back({t.x_min - region.x_min, t.y_min - region.y_min, t.width(), t.height()});
  }
  return tiles;
}

py::array_t<float> read(Session& session, const std::string& pass, std::uint32_t x, std::uint32_t y,
                        const std::optional<std::uint32_t>& width,
                        const std::optional<std::uint32_t>& height) {
  const Rect& region = session.settings().region;
  if (x > region.width() || y > region.height()) {
    throw std::invalid_argument("the rectangle to read lies outside the film");
  }
  const std::uint32_t w = width.value_or(region.width() - x);
  const std::uint32_t h = height.value_or(region.height() - y);
  if (w > region.width() - x || h > region.height() - y) {
    throw std::invalid_argument("the rectangle to read lies outside the film");
  }
  const Rect rect{region.x_min + x, region.y_min + y, region.x_min + x + w, region.y_min + y + h};
  py::array_t<float> out({py::ssize_t{h}, py::ssize_t{w}, py::ssize_t{find_pass(pass).channels}});
  float* data = out.mutable_data();
  const py::gil_scoped_release release;
  session.read(pass, rect, data);
  return out;
}

py::dict progress(const Session& session) {
  const Progress p = session.progress();
  py::dict d;
  d["sample"] = p.sample;
  d["samples"] = p.samples;
  d["tile"] = p.tile;
  d["tiles"] = p.tiles;
  d["mean_samples"] = p.mean_samples;
  d["fraction"] = p.fraction;
  d["elapsed"] = p.elapsed;
  d["remaining"] = p.remaining;
  d["rays"] = p.rays;
  d["ambient_rays"] = p.ambient.cast;
  d["ambient_rays_blocked"] = p.ambient.blocked;
  d["clamped_samples"] = p.clamped_samples;
  return d;
}

py::dict resolved(const Session& session) {
  py::dict d;
  d["light_samples"] = session.light_samples();
  if (const AdaptiveRule& rule = session.adaptive_rule(); rule.in_use()) {
    d["adaptive_threshold"] = rule.threshold();
    d["adaptive_min_samples"] = rule.min_samples();
  }
  return d;
}

std::optional<std::string> error(const Session& session) {
  const std::string message = session.error();
  return message.empty() ? std::nullopt : std::optional(message);
}

void bind_settings(py::module_& module) {
  const Settings d;
  py::class_<Settings, std::shared_ptr<Settings>>(
      module, "Settings", "How to render; names and defaults are those of scene.komorebi.")
      .def(py::init(&make_settings), py::kw_only(), py::arg("method") = "AMBIENT_OCCLUSION",
           py::arg("samples") = d.samples, py::arg("light_samples") = d.light_samples,
           py::arg("sample_offset") = d.sample_offset, py::arg("seed") = d.seed,
           py::arg("use_adaptive_sampling") = d.use_adaptive_sampling,
           py::arg("adaptive_threshold") = d.adaptive_threshold,
           py::arg("adaptive_min_samples") = d.adaptive_min_samples,
           py::arg("time_limit") = d.time_limit, py::arg("ao_distance") = d.ao_distance,
           py::arg("ao_sampling") = "COSINE",
           py::arg("clay_color") = std::array<float, 3>{0.8f, 0.8f, 0.8f}, py::arg("bounces") = 0,
           py::arg("sample_clamp_direct") = 0.0f, py::arg("sample_clamp_indirect") = 10.0f,
           py::arg("world_max_bounces") = d.world_max_bounces, py::arg("use_fast_gi") = false,
           py::arg("fast_gi_method") = "REPLACE", py::arg("fast_gi_bounces") = d.fast_gi_bounces,
           py::arg("fast_gi_distance") = d.fast_gi_distance,
           py::arg("fast_gi_factor") = d.fast_gi_factor,
           py::arg("environment_sampling") = "PRODUCT", py::arg("pixel_filter") = "BLACKMAN_HARRIS",
           py::arg("filter_width") = d.filter_width, py::arg("use_progressive") = d.use_progressive,
           py::arg("film_transparent") = d.film_transparent, py::arg("mist_start") = d.mist_start,
           py::arg("mist_depth") = d.mist_depth, py::arg("mist_falloff") = "QUADRATIC",
           py::arg("threads") = d.threads, py::arg("tile_size") = d.tile_size,
           py::arg("region") = std::optional<Region>(), py::arg("passes") = d.passes,
           py::arg("guides_light") = d.guides_light,
           py::arg("has_low_priority") = d.has_low_priority,
           py::arg("samples_per_pass") = d.samples_per_pass,
           "region: (x_min, y_min, x_max, y_max) in full-frame pixels, half open, row 0 at the "
           "bottom; None is the whole frame. threads 0: one a core. guides_light: whether the "
           "parts of the sky that surfaces see are measured first. has_low_priority: whether its "
           "threads let others come first. samples_per_pass: of a pixel before the next one's. "
           "ValueError for a name that is not known; ranges are "
           "checked when a Session starts.");
}

}  // namespace

void bind_session(py::module_& module) {
  module.attr("AUTOMATIC_LIGHT_SAMPLES") = kAutomaticLightSamples;
  module.def("film_bytes_per_pixel", &Film::bytes_per_pixel, py::arg("passes"),
             "Memory that a Session takes for each pixel, about.");
  bind_settings(module);
  py::class_<Session, std::shared_ptr<Session>>(
      module, "Session", "Renders a committed scene on threads of its own; it starts at once.")
      .def(
          py::init([](std::shared_ptr<Scene> scene, const Settings& settings,
                      const std::shared_ptr<CameraDesc>& camera,
                      const std::shared_ptr<Cancel>& cancel) {
            const py::gil_scoped_release release;
            return new Session(std::move(scene), settings,
                               camera ? std::optional(*camera) : std::nullopt,
                               cancel_or_never(cancel));
          }),
          py::arg("scene"), py::arg("settings"), py::arg("camera") = py::none(),
          py::arg("cancel") = std::shared_ptr<Cancel>(),
          "camera: a Camera in place of the scene's own. cancel: ends what comes before the start. "
          "ValueError: the scene is not committed or has no camera, a setting is out of range. "
          "Raises Cancelled.")
      .def("wait", &Session::wait, py::arg("timeout"), py::call_guard<py::gil_scoped_release>(),
           "True when the render is over (done, cancelled or failed) within `timeout` seconds.")
      .def("cancel", &Session::cancel, "Ends the render within 100 ms; what is done stays.")
      .def("resume", &Session::resume, py::call_guard<py::gil_scoped_release>(),
           "Goes on after a cancel with what is missing.")
      .def("updated_tiles", &updated_tiles,
           "(x, y, width, height) of tiles changed since the last call, within the region.")
      .def(
          "progress", &progress,
          "sample (whole passes over the frame), samples, tile and tiles (of the pass that is on), "
          "mean_samples (a pixel), fraction, elapsed and remaining (seconds), rays, "
          "ambient_rays and of them ambient_rays_blocked, clamped_samples.")
      .def_property_readonly(
          "resolved", &resolved,
          "What was automatic in the settings, decided: light_samples, and under "
          "adaptive sampling adaptive_threshold and adaptive_min_samples.")
      .def("read", &read, py::arg("pass_name"), py::arg("x") = 0, py::arg("y") = 0,
           py::arg("width") = py::none(), py::arg("height") = py::none(),
           "A pass as float32 [height, width, channels], row 0 at the bottom; known_passes() has "
           "the channels of each. Combined is premultiplied and scene linear. ValueError for a "
           "pass that the settings did not name.")
      .def_property_readonly("error", &error)
      .def_property_readonly("byte_count", &Session::byte_count);
  auto scene =
      py::reinterpret_borrow<py::class_<Scene, std::shared_ptr<Scene>>>(module.attr("Scene"));
  scene.def(
      "dump",
      [](const Scene& self, const std::string& path, const Settings& settings) {
        const py::gil_scoped_release release;
        write_dump(path, self, settings);
      },
      py::arg("path"), py::arg("settings"),
      "Writes the scene and how to render it into one file for the program `komorebi`.");
}

}  // namespace komorebi::python
