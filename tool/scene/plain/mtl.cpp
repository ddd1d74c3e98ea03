// Reads the material libraries of OBJ files.
#include "mtl.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "../message.h"
#include "letters.h"
#include "text_reader.h"

namespace vitrail::tool {
namespace {

// Decimals may follow a comma, and a comma the number.
bool parseMtlNumber(std::string_view word, float& value) {
  if (parseFloat(word, value)) return true;
  std::string text(word);
  if (text.ends_with(',')) text.pop_back();
  if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos) std::ranges::replace(text, ',', '.');
  return !text.empty() && parseFloat(text, value);
}

std::optional<float> readNumber(TextLines& lines) {
  float value = 0.0F;
  if (!parseMtlNumber(lines.word(), value)) return std::nullopt;
  return value;
}

bool nextIsNumber(const TextLines& lines) {
  const std::string_view rest = lines.rest();
  float number = 0.0F;
  return parseMtlNumber(rest.substr(0, rest.find_first_of(" \t")), number);
}

// One number stands for all three. None for other ways to state a colour, such as a spectral curve.
std::optional<glm::vec3> readColor(TextLines& lines) {
  const std::optional<float> red = readNumber(lines);
  if (!red) return std::nullopt;
  glm::vec3 color(*red);
  for (int c = 1; c < 3 && nextIsNumber(lines); ++c) color[c] = readNumber(lines).value_or(*red);
  return color;
}

// Up to so many numbers, of which the first two are kept; those that are missing are `other`.
glm::vec2 readPair(TextLines& lines, int most, float other) {
  glm::vec2 pair(other);
  for (int i = 0; i < most && nextIsNumber(lines); ++i) {
    const float value = readNumber(lines).value_or(other);
    if (i < 2) pair[i] = value;
  }
  return pair;
}

class MtlReader {
 public:
  explicit MtlReader(std::string_view text) : lines_(text) {}

  MtlLibrary read() {
    while (lines_.next()) {
      if (lines_.rest().starts_with('#')) {
        readComment();
        continue;
      }
      // Programs differ in the letter case of the words.
      const std::string_view written = lines_.word();
      const std::string word = lowerCase(written);
      if (word == "newmtl")
        startMaterial();
      else if (material_ != nullptr && !readColors(word) && !readNumbers(word) && !readMaps(word))
        readOther(word, written);
    }
    decideTransparency();
    return std::move(library_);
  }

 private:
  void startMaterial() {
    std::string name(lines_.rest());
    const std::string_view bare = beforeComment(name);
    if (bare.size() != name.size()) library_.withoutComment.try_emplace(std::string(bare), name);
    material_ = &library_.materials[name];
    *material_ = {};
    material_->name = std::move(name);
  }

  void readComment() {
    const std::string comment = lowerCase(lines_.rest());
    for (const char* program : {"meshlab", "vcglib", "openmvs", "mvs-texturing", "texrecon"})
      writerMeansOpacity_ = writerMeansOpacity_ || comment.find(program) != std::string::npos;
  }

  bool readColors(std::string_view word) {
    std::optional<glm::vec3>* color = word == "kd"   ? &material_->diffuse
                                      : word == "ks" ? &material_->specular
                                      : word == "ke" ? &material_->emissive
                                      : word == "tf" ? &material_->filter
                                                     : nullptr;
    if (color == nullptr) return false;
    const std::string way = lowerCase(lines_.rest());
    if (const auto value = readColor(lines_))
      *color = value;
    else if (way.starts_with("xyz") || way.starts_with("spectral"))
      warn(fmt::format("a colour stated as {} is not read: material \"{}\" has the default one",
                       way.starts_with("xyz") ? "xyz" : "spectral", oneLine(material_->name)),
           "xyz or spectral");
    return true;
  }

  bool readNumbers(std::string_view word) {
    const std::array<std::pair<std::string_view, std::optional<float>*>, 9> numbers{
        {{"ns", &material_->shininess},
         {"d", &material_->dissolve},
         {"tr", &material_->transparency},
         {"ni", &material_->refraction},
         {"pr", &material_->roughness},
         {"pm", &material_->metallic},
         {"ps", &material_->sheen},
         {"pc", &material_->clearcoat},
         {"pcr", &material_->clearcoatRoughness}}};
    if (word == "illum") {
      if (const auto value = readNumber(lines_); value && *value >= 0.0F && *value < 100.0F)
        material_->illumination = static_cast<int>(*value);
      return true;
    }
    const auto* found = std::ranges::find(numbers, word, &std::pair<std::string_view, std::optional<float>*>::first);
    if (found == numbers.end()) return false;
    if (lines_.rest().starts_with("-halo")) {
      lines_.word();
      warn("d -halo is drawn as d: what should fade towards its edges is equally opaque everywhere");
    }
    if (const auto value = readNumber(lines_)) *found->second = value;
    return true;
  }

  bool readMaps(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, MtlMap MtlMaterial::*>, 12> maps{
        {{"map_kd", &MtlMaterial::diffuseMap},
         {"map_d", &MtlMaterial::opacityMap},
         {"map_opacity", &MtlMaterial::opacityMap},
         {"map_ke", &MtlMaterial::emissiveMap},
         {"map_emissive", &MtlMaterial::emissiveMap},
         {"map_pr", &MtlMaterial::roughnessMap},
         {"map_pm", &MtlMaterial::metallicMap},
         {"norm", &MtlMaterial::normalMap},
         {"map_kn", &MtlMaterial::normalMap},
         {"map_norm", &MtlMaterial::normalMap},
         {"bump", &MtlMaterial::bumpMap},
         {"map_bump", &MtlMaterial::bumpMap}}};
    const auto* found = std::ranges::find(maps, word, &std::pair<std::string_view, MtlMap MtlMaterial::*>::first);
    if (found == maps.end()) return false;
    material_->*(found->second) = readMap();
    return true;
  }

  // The options in front of the file's name, which may hold spaces.
  MtlMap readMap() {
    MtlMap map;
    while (lines_.rest().starts_with('-')) {
      const std::string option = lowerCase(lines_.word());
      if (option == "-s") {
        map.scale = readPair(lines_, 3, 1.0F);
      } else if (option == "-o") {
        map.offset = readPair(lines_, 3, 0.0F);
      } else if (option == "-t") {
        if (readPair(lines_, 3, 0.0F) != glm::vec2(0.0F))
          warn("the option -t is not drawn: pictures lack their turbulence");
      } else if (option == "-mm") {
        const glm::vec2 values = readPair(lines_, 2, 1.0F);
        map.base = values.x;
        map.gain = values.y;
      } else if (option == "-bm") {
        map.strength = readNumber(lines_).value_or(1.0F);
      } else if (option == "-clamp") {
        map.clamp = lowerCase(lines_.word()) == "on";
      } else if (option == "-imfchan") {
        const std::string channel = lowerCase(lines_.word());
        map.channel = channel.empty() ? '\0' : channel[0];
      } else {
        lines_.word(); // -blendu, -blendv, -boost, -cc, -texres, -type: how a picture is filtered
      }
    }
    map.name = lines_.rest();
    return map;
  }

  void readOther(std::string_view word, std::string_view written) {
    constexpr std::array<std::pair<std::string_view, const char*>, 11> lost{
        {{"map_ka", "its surfaces are lit by their surroundings without that picture"},
         {"map_ks", "the highlights of its surfaces are the same everywhere"},
         {"map_ns", "its surfaces are equally rough everywhere"},
         {"map_ps", "its surfaces lack that part of their rim"},
         {"map_refl", "its surfaces lack that reflection"},
         {"refl", "its surfaces lack that reflection"},
         {"disp", "its surfaces lack that relief"},
         {"map_disp", "its surfaces lack that relief"},
         {"decal", "its surfaces lack that picture"},
         {"map_tr", "its surfaces are equally opaque everywhere"},
         {"aniso", "its highlights are round"}}};
    const auto* found = std::ranges::find(lost, word, &std::pair<std::string_view, const char*>::first);
    if (found == lost.end() || !lines_.more() || lines_.rest().starts_with("0 ") || lines_.rest() == "0") return;
    if (word == "aniso" && readNumber(lines_).value_or(0.0F) == 0.0F) return;
    warn(fmt::format("{} of the material \"{}\" is not drawn: {}", oneLine(written), oneLine(material_->name),
                     found->second),
         word);
  }

  // Once a kind of statement, whichever materials have it.
  void warn(std::string line, std::string_view kind = {}) {
    const std::string key = kind.empty() ? line : std::string(kind);
    if (std::ranges::find(warned_, key) != warned_.end()) return;
    warned_.push_back(key);
    library_.warnings.push_back(std::move(line));
  }

  void decideTransparency() {
    bool one = false;
    bool zero = false;
    for (const auto& [name, material] : library_.materials) {
      if (material.dissolve || !material.transparency) continue;
      one = one || *material.transparency == 1.0F;
      zero = zero || *material.transparency == 0.0F;
    }
    library_.transparencyIsOpacity = (one || writerMeansOpacity_) && !zero;
  }

  TextLines lines_;
  MtlLibrary library_;
  MtlMaterial* material_ = nullptr;
  bool writerMeansOpacity_ = false;
  std::vector<std::string> warned_;
};

} // namespace

const MtlMaterial* MtlLibrary::find(std::string_view name) const {
  const auto found = materials.find(name);
  if (found != materials.end()) return &found->second;
  const auto bare = withoutComment.find(name);
  return bare == withoutComment.end() ? nullptr : &materials.at(bare->second);
}

MtlLibrary readMtl(std::string_view text) { return MtlReader(text).read(); }

float opacityOf(const MtlMaterial& material, const MtlLibrary& library) {
  if (material.dissolve) return std::clamp(*material.dissolve, 0.0F, 1.0F);
  if (material.transparency) {
    const float stated = std::clamp(*material.transparency, 0.0F, 1.0F);
    if (stated == 0.0F) return 1.0F;
    return library.transparencyIsOpacity || stated == 1.0F ? stated : 1.0F - stated;
  }
  if (!material.filter) return 1.0F;
  const float mean = (material.filter->r + material.filter->g + material.filter->b) / 3.0F;
  return mean > 0.0F && mean < 1.0F ? mean : 1.0F;
}

std::string_view beforeComment(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] != '#' || (text[i - 1] != ' ' && text[i - 1] != '\t')) continue;
    text = text.substr(0, i);
    break;
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

} // namespace vitrail::tool
