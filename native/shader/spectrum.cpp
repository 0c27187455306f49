#include "shader/spectrum.h"

#include <algorithm>
#include <iterator>

#include "shader/op_lanes.h"
#include "shader/op_table.h"
#include "shader/scalar_math.h"

namespace komorebi {
namespace {

// From a temperature on: a / t + b t + c of red and green, a cubic's coefficients of blue.
struct Fit {
  float from;
  float red[3], green[3], blue[4];
};
constexpr Fit kFits[] = {
    {800.0f,
     {1.61919106e+03f, -2.05010916e-03f, 5.02995757f},
     {-4.88999748e+02f, 6.04330754e-04f, -7.55807526e-02f},
     {5.96945309e-11f, -4.85742887e-08f, -9.70622247e-05f, -4.07936148e-03f}},
    {965.0f,
     {2.48845471e+03f, -1.11330907e-03f, 3.22621544f},
     {-7.55994277e+02f, 3.16730098e-04f, 4.78306139e-01f},
     {2.40430366e-11f, 5.55021075e-08f, -1.98503712e-04f, 2.89312858e-02f}},
    {1167.0f,
     {3.34143193e+03f, -4.86551192e-04f, 1.76486769f},
     {-1.02363977e+03f, 1.20223470e-04f, 9.36662319e-01f},
     {-1.40949732e-11f, 1.89878968e-07f, -3.56632824e-04f, 9.10767778e-02f}},
    {1449.0f,
     {4.09461742e+03f, -1.27446582e-04f, 7.25731635e-01f},
     {-1.26571316e+03f, 4.87340896e-06f, 1.27054498f},
     {-3.61460868e-11f, 2.84822009e-07f, -4.93211319e-04f, 1.56723440e-01f}},
    {1902.0f,
     {4.67028036e+03f, 2.91258199e-05f, 1.26703442e-01f},
     {-1.42529332e+03f, -4.01150431e-05f, 1.43972784f},
     {-1.97075738e-11f, 1.75359352e-07f, -2.50542825e-04f, -2.22783266e-02f}},
    {3315.0f,
     {4.59509185e+03f, 2.87495649e-05f, 1.50345020e-01f},
     {-1.17554822e+03f, -2.16378048e-05f, 1.30408023f},
     {-1.61997957e-13f, -1.64216008e-08f, 3.86216271e-04f, -7.38077418e-01f}},
    {6365.0f,
     {3.78717450e+03f, 9.35907826e-06f, 3.99075871e-01f},
     {-5.00799571e+02f, -4.59832026e-06f, 1.09098763f},
     {6.72650283e-13f, -2.73078809e-08f, 4.24098264e-04f, -7.52335691e-01f}},
};

// CIE 1931 colour matching functions x, y, z of the 2° observer, every 5 nm from 380 nm on.
constexpr float kMatching[][3] = {
    {0.0014f, 0.0000f, 0.0065f}, {0.0022f, 0.0001f, 0.0105f}, {0.0042f, 0.0001f, 0.0201f},
    {0.0076f, 0.0002f, 0.0362f}, {0.0143f, 0.0004f, 0.0679f}, {0.0232f, 0.0006f, 0.1102f},
    {0.0435f, 0.0012f, 0.2074f}, {0.0776f, 0.0022f, 0.3713f}, {0.1344f, 0.0040f, 0.6456f},
    {0.2148f, 0.0073f, 1.0391f}, {0.2839f, 0.0116f, 1.3856f}, {0.3285f, 0.0168f, 1.6230f},
    {0.3483f, 0.0230f, 1.7471f}, {0.3481f, 0.0298f, 1.7826f}, {0.3362f, 0.0380f, 1.7721f},
    {0.3187f, 0.0480f, 1.7441f}, {0.2908f, 0.0600f, 1.6692f}, {0.2511f, 0.0739f, 1.5281f},
    {0.1954f, 0.0910f, 1.2876f}, {0.1421f, 0.1126f, 1.0419f}, {0.0956f, 0.1390f, 0.8130f},
    {0.0580f, 0.1693f, 0.6162f}, {0.0320f, 0.2080f, 0.4652f}, {0.0147f, 0.2586f, 0.3533f},
    {0.0049f, 0.3230f, 0.2720f}, {0.0024f, 0.4073f, 0.2123f}, {0.0093f, 0.5030f, 0.1582f},
    {0.0291f, 0.6082f, 0.1117f}, {0.0633f, 0.7100f, 0.0782f}, {0.1096f, 0.7932f, 0.0573f},
    {0.1655f, 0.8620f, 0.0422f}, {0.2257f, 0.9149f, 0.0298f}, {0.2904f, 0.9540f, 0.0203f},
    {0.3597f, 0.9803f, 0.0134f}, {0.4334f, 0.9950f, 0.0087f}, {0.5121f, 1.0000f, 0.0057f},
    {0.5945f, 0.9950f, 0.0039f}, {0.6784f, 0.9786f, 0.0027f}, {0.7621f, 0.9520f, 0.0021f},
    {0.8425f, 0.9154f, 0.0018f}, {0.9163f, 0.8700f, 0.0017f}, {0.9786f, 0.8163f, 0.0014f},
    {1.0263f, 0.7570f, 0.0011f}, {1.0567f, 0.6949f, 0.0010f}, {1.0622f, 0.6310f, 0.0008f},
    {1.0456f, 0.5668f, 0.0006f}, {1.0026f, 0.5030f, 0.0003f}, {0.9384f, 0.4412f, 0.0002f},
    {0.8544f, 0.3810f, 0.0002f}, {0.7514f, 0.3210f, 0.0001f}, {0.6424f, 0.2650f, 0.0000f},
    {0.5419f, 0.2170f, 0.0000f}, {0.4479f, 0.1750f, 0.0000f}, {0.3608f, 0.1382f, 0.0000f},
    {0.2835f, 0.1070f, 0.0000f}, {0.2187f, 0.0816f, 0.0000f}, {0.1649f, 0.0610f, 0.0000f},
    {0.1212f, 0.0446f, 0.0000f}, {0.0874f, 0.0320f, 0.0000f}, {0.0636f, 0.0232f, 0.0000f},
    {0.0468f, 0.0170f, 0.0000f}, {0.0329f, 0.0119f, 0.0000f}, {0.0227f, 0.0082f, 0.0000f},
    {0.0158f, 0.0057f, 0.0000f}, {0.0114f, 0.0041f, 0.0000f}, {0.0081f, 0.0029f, 0.0000f},
    {0.0058f, 0.0021f, 0.0000f}, {0.0041f, 0.0015f, 0.0000f}, {0.0029f, 0.0010f, 0.0000f},
    {0.0020f, 0.0007f, 0.0000f}, {0.0014f, 0.0005f, 0.0000f}, {0.0010f, 0.0004f, 0.0000f},
    {0.0007f, 0.0002f, 0.0000f}, {0.0005f, 0.0002f, 0.0000f}, {0.0003f, 0.0001f, 0.0000f},
    {0.0002f, 0.0001f, 0.0000f}, {0.0002f, 0.0001f, 0.0000f}, {0.0001f, 0.0000f, 0.0000f},
    {0.0001f, 0.0000f, 0.0000f}, {0.0001f, 0.0000f, 0.0000f}, {0.0000f, 0.0000f, 0.0000f}};

Vec3 shown(const Vec3& c) {
  return Vec3(node::most(c.x, 0.0f), node::most(c.y, 0.0f), node::most(c.z, 0.0f));
}

constexpr OpInfo kOps[] = {
    {"blackbody",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) { return node::blackbody(c.in[0][i]); });
     },
     1, 3},
    {"wavelength",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) { return node::wavelength(c.in[0][i]); });
     },
     1, 3},
};

}  // namespace

Vec3 node::blackbody(float kelvin) {
  if (kelvin >= 12000.0f) return Vec3(0.8262954810f, 0.9945080501f, 1.5663077103f);
  if (!(kelvin >= 800.0f)) return Vec3(5.4132944901f, 0.0f, 0.0f);
  const auto above = std::find_if(std::begin(kFits), std::end(kFits),
                                  [&](const Fit& fit) { return fit.from > kelvin; });
  const Fit& fit = *std::prev(above);
  const auto channel = [&](const float(&c)[3]) { return c[0] / kelvin + c[1] * kelvin + c[2]; };
  const float blue =
      ((fit.blue[0] * kelvin + fit.blue[1]) * kelvin + fit.blue[2]) * kelvin + fit.blue[3];
  return shown(Vec3(channel(fit.red), channel(fit.green), blue));
}

Vec3 node::wavelength(float nanometres) {
  const float place = (nanometres - 380.0f) * 0.2f;
  if (!(place > -1.0f && place < 80.0f)) return Vec3(0.0f);
  const auto row = static_cast<std::int32_t>(place);
  const float t = place - static_cast<float>(row);
  const auto at = [&](std::int32_t k) {
    return Vec3(kMatching[k][0], kMatching[k][1], kMatching[k][2]);
  };
  const Vec3 xyz = at(row) * (1.0f - t) + at(row + 1) * t;
  const Vec3 rgb(3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
                 -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
                 0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z);
  return shown(rgb * (1.0f / 2.52f));
}

std::span<const OpInfo> spectrum_ops() {
  return kOps;
}

}  // namespace komorebi
