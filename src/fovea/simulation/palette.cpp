#include "fovea/simulation/palette.h"

#include <array>

namespace fovea {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

Vector3f srgb(int r, int g, int b) {
  return decode_srgb(
      {static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)});
}

class PaletteMaker {
 public:
  Palette palette;

  std::uint16_t add(Material m) {
    m.seed = static_cast<std::uint32_t>(97 * palette.materials.size() + 11);
    palette.materials.push_back(std::move(m));
    return static_cast<std::uint16_t>(palette.materials.size() - 1);
  }
  std::uint16_t plain(const char* name, const Vector3f& color, float reflectance, float gloss = 0) {
    Material m;
    m.name = name;
    m.color = color;
    m.reflectance = reflectance;
    m.gloss = gloss;
    return add(m);
  }
  std::uint16_t patterned(const char* name, Pattern pattern, const Vector3f& color,
                          const Vector3f& color_2, const Vector2f& size, float reflectance) {
    Material m;
    m.name = name;
    m.pattern = pattern;
    m.color = color;
    m.color_2 = color_2;
    m.size = size;
    m.scale = size.x();
    m.reflectance = reflectance;
    return add(m);
  }
  std::uint16_t lettering(const char* name, const char* text, const Vector3f& board,
                          const Vector3f& ink, const Vector2f& size, float reflectance) {
    Material m;
    m.name = name;
    m.pattern = Pattern::kLettering;
    m.text = text;
    m.color = board;
    m.color_2 = ink;
    m.size = size;
    m.reflectance = reflectance;
    return add(m);
  }
};

void add_ground(PaletteMaker& make) {
  Palette& p = make.palette;
  const Vector3f none = Vector3f::Zero();
  p.road = make.patterned("road", Pattern::kRoad, srgb(98, 98, 101), srgb(222, 222, 214),
                          {5.7f, 6.0f}, 0.22f);
  p.asphalt = make.patterned("asphalt", Pattern::kAsphalt, srgb(94, 94, 97), none, {1, 1}, 0.22f);
  p.kerb = make.patterned("kerb", Pattern::kSlabs, srgb(168, 166, 160), srgb(88, 86, 82),
                          {1.0f, 10.0f}, 0.45f);
  p.pavement = make.patterned("pavement", Pattern::kSlabs, srgb(158, 153, 146), srgb(92, 88, 82),
                              {0.5f, 0.5f}, 0.40f);
  p.plaza = make.patterned("plaza", Pattern::kSlabs, srgb(184, 172, 154), srgb(110, 102, 92),
                           {0.8f, 0.4f}, 0.42f);
  p.grass = make.patterned("grass", Pattern::kGrass, srgb(96, 122, 58), srgb(132, 138, 74), {1, 1},
                           0.35f);
  p.soil = make.patterned("soil", Pattern::kGrain, srgb(96, 76, 58), none, {1, 1}, 0.30f);
}

void add_buildings(PaletteMaker& make) {
  Palette& p = make.palette;
  const Vector2f brick{0.24f, 0.075f};
  const Vector3f mortar = srgb(176, 170, 160);
  for (const Vector3f& color :
       {srgb(150, 78, 60), srgb(168, 110, 76), srgb(122, 66, 56), srgb(176, 150, 118)}) {
    p.walls.push_back(make.patterned("brick wall", Pattern::kBricks, color, mortar, brick, 0.40f));
  }
  for (const Vector3f& color : {srgb(222, 206, 170), srgb(206, 196, 186), srgb(214, 178, 140),
                                srgb(178, 192, 196), srgb(226, 222, 212), srgb(200, 160, 148)}) {
    p.walls.push_back(make.patterned("plaster wall", Pattern::kGrain, color, color, {1, 1}, 0.55f));
  }
  for (const Vector3f& color : {srgb(170, 160, 148), srgb(150, 120, 100), srgb(190, 182, 168)}) {
    p.distant.push_back(make.patterned("distant house", Pattern::kFacade, color, srgb(58, 66, 76),
                                       {2.6f, 3.0f}, 0.40f));
  }
  p.concrete = make.patterned("concrete", Pattern::kGrain, srgb(172, 168, 162), Vector3f::Zero(),
                              {1, 1}, 0.45f);
  p.roof_tiles = make.patterned("roof tiles", Pattern::kBricks, srgb(146, 74, 54), srgb(84, 44, 36),
                                {0.30f, 0.34f}, 0.35f);
  p.roof_felt = make.patterned("roof felt", Pattern::kGrain, srgb(84, 82, 82), Vector3f::Zero(),
                               {1, 1}, 0.20f);
  p.frame_white = make.plain("white frame", srgb(232, 232, 226), 0.6f);
  p.frame_dark = make.plain("dark frame", srgb(64, 58, 52), 0.3f);
  p.curtain = make.patterned("curtain", Pattern::kBoards, srgb(208, 204, 194), Vector3f::Zero(),
                             {0.09f, 1}, 0.4f);
  for (const Vector3f& color :
       {srgb(120, 40, 36), srgb(40, 72, 60), srgb(44, 58, 96), srgb(110, 78, 50)}) {
    p.doors.push_back(
        make.patterned("door", Pattern::kBoards, color, Vector3f::Zero(), {0.13f, 1}, 0.35f));
  }
  struct Sign {
    const char* text;
    Vector3f board, ink;
  };
  const std::array<Sign, 10> signs{{{"BAKERY", srgb(122, 44, 38), srgb(246, 232, 200)},
                                    {"CAFE NORD", srgb(40, 60, 54), srgb(238, 234, 220)},
                                    {"BOOKS", srgb(232, 222, 196), srgb(52, 44, 40)},
                                    {"FLOWERS", srgb(70, 112, 70), srgb(250, 244, 214)},
                                    {"PHARMACY", srgb(240, 240, 236), srgb(20, 120, 72)},
                                    {"HOTEL 21", srgb(34, 44, 78), srgb(232, 200, 110)},
                                    {"BICYCLES", srgb(216, 170, 50), srgb(40, 40, 44)},
                                    {"OPTICIAN", srgb(236, 236, 240), srgb(24, 60, 130)},
                                    {"RECORDS", srgb(30, 30, 32), srgb(230, 72, 60)},
                                    {"PIZZA 4 YOU", srgb(180, 36, 34), srgb(252, 248, 238)}}};
  for (const Sign& sign : signs) {
    p.shop_signs.push_back(
        make.lettering("shop sign", sign.text, sign.board, sign.ink, kShopSign, 0.5f));
  }
}

void add_glass_and_metal(PaletteMaker& make) {
  Palette& p = make.palette;
  Material glass;
  glass.name = "window";
  glass.color = srgb(44, 50, 56);
  glass.gloss = 0.12f;
  glass.glass = true;
  glass.reflectance = 0.05f;
  p.glass = make.add(glass);
  glass.name = "car window";
  glass.color = srgb(26, 30, 34);
  p.car_glass = make.add(glass);
  p.metal = make.plain("metal", srgb(138, 142, 146), 0.5f, 0.05f);
  p.dark_metal = make.plain("dark metal", srgb(52, 56, 60), 0.3f);
  p.chrome = make.plain("chrome", srgb(170, 172, 176), 0.6f, 0.4f);
  p.rubber = make.plain("rubber", srgb(34, 34, 36), 0.06f);
  p.headlight = make.plain("headlight", srgb(228, 230, 232), 0.7f, 0.1f);
  p.taillight = make.plain("tail light", srgb(150, 20, 22), 0.6f, 0.06f);
  p.sign_red = make.plain("sign red", srgb(196, 30, 36), 0.95f);
  p.wood = make.patterned("wood", Pattern::kBoards, srgb(140, 104, 66), Vector3f::Zero(),
                          {0.12f, 1}, 0.35f);
}

void add_people_and_plants(PaletteMaker& make) {
  Palette& p = make.palette;
  p.skin = make.plain("skin", srgb(206, 160, 132), 0.5f);
  p.hair = make.plain("hair", srgb(66, 48, 36), 0.2f);
  p.trousers = make.plain("trousers", srgb(48, 54, 76), 0.25f);
  p.bark = make.patterned("bark", Pattern::kBark, srgb(98, 82, 66), Vector3f::Zero(), {1, 1}, 0.3f);
  p.leaves.push_back(make.patterned("leaves", Pattern::kFoliage, srgb(78, 112, 44),
                                    srgb(122, 140, 62), {1, 1}, 0.45f));
  p.leaves.push_back(make.patterned("leaves", Pattern::kFoliage, srgb(60, 96, 50),
                                    srgb(96, 126, 70), {1, 1}, 0.45f));
  p.leaves.push_back(make.patterned("autumn leaves", Pattern::kFoliage, srgb(150, 122, 50),
                                    srgb(176, 96, 44), {1, 1}, 0.45f));
}

void add_choices(PaletteMaker& make) {
  Palette& p = make.palette;
  for (const Vector3f& color :
       {srgb(206, 208, 210), srgb(150, 154, 158), srgb(40, 42, 46), srgb(232, 232, 230),
        srgb(142, 26, 30), srgb(34, 58, 112), srgb(70, 96, 84), srgb(184, 150, 60),
        srgb(96, 70, 60), srgb(92, 120, 150)}) {
    p.car_paints.push_back(make.plain("car paint", color, 0.35f, 0.06f));
  }
  for (const Vector3f& color : {srgb(170, 44, 44), srgb(54, 92, 150), srgb(222, 216, 200),
                                srgb(64, 64, 68), srgb(196, 160, 70), srgb(92, 128, 92)}) {
    p.clothes.push_back(make.plain("cloth", color, 0.4f));
  }
  for (const char* text : {"MILL ROAD", "ELM STREET", "STATION RD", "QUAY 7"}) {
    p.street_signs.push_back(make.lettering("street sign", text, srgb(30, 70, 140),
                                            srgb(244, 244, 244), kStreetSign, 0.9f));
  }
  for (const char* text : {"KA 7204", "FV 1138", "MN 0451", "TE 9310", "HD 2501", "RX 6612"}) {
    p.plates.push_back(
        make.lettering("number plate", text, srgb(236, 236, 232), srgb(20, 20, 22), kPlate, 0.95f));
  }
}

}  // namespace

Palette make_palette() {
  PaletteMaker make;
  make.plain("paint", Vector3f::Constant(0.5f), 0.4f);  // kPaint
  add_ground(make);
  add_buildings(make);
  add_glass_and_metal(make);
  add_people_and_plants(make);
  add_choices(make);
  return std::move(make.palette);
}

}  // namespace fovea
