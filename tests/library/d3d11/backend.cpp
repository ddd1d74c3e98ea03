#include "backend.h"

#include <d3dcompiler.h>

#include <array>
#include <fstream>
#include <iterator>
#include <utility>

#include "point_host.h"

namespace vitrail::tests::d3d11 {

namespace {

const Registered<D3d11Backend> registered;

std::string textOf(const std::string& name) {
  std::ifstream stream(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Everything that is included lies in shaders/vitrail.
class Includes : public ID3DInclude {
 public:
  HRESULT STDMETHODCALLTYPE Open(D3D_INCLUDE_TYPE /*type*/, LPCSTR name, LPCVOID /*parent*/, LPCVOID* data,
                                 UINT* bytes) override {
    const std::string base = name;
    std::string& text = texts_[base.substr(base.find_last_of('/') + 1)];
    if (text.empty())
      text = textOf(std::string(VITRAIL_SHADERS) + "/vitrail/" + base.substr(base.find_last_of('/') + 1));
    if (text.empty()) return E_FAIL;
    *data = text.data();
    *bytes = static_cast<UINT>(text.size());
    return S_OK;
  }
  HRESULT STDMETHODCALLTYPE Close(LPCVOID /*data*/) override { return S_OK; }

 private:
  std::map<std::string, std::string> texts_;
};

// Compiles a file of the tests' shaders at run time: a shader for one kind of target is one of many.
Com<ID3DBlob> compile(const std::string& file, const char* entry, const char* profile, const Defines& defines) {
  const std::string name = std::string(VITRAIL_TEST_SHADERS) + "/" + file + ".hlsl";
  const std::string text = textOf(name);
  std::vector<std::pair<std::string, std::string>> words;
  for (const std::string& define : defines) {
    const std::size_t equals = define.find('=');
    words.emplace_back(define.substr(0, equals), equals == std::string::npos ? "1" : define.substr(equals + 1));
  }
  std::vector<D3D_SHADER_MACRO> macros;
  for (const auto& [macro, value] : words) macros.push_back({macro.c_str(), value.c_str()});
  macros.push_back({nullptr, nullptr});
  Includes includes;
  Com<ID3DBlob> code;
  Com<ID3DBlob> said;
  const HRESULT result = D3DCompile(text.data(), text.size(), name.c_str(), macros.data(), &includes, entry, profile, 0,
                                    0, code.out(), said.out());
  if (FAILED(result)) {
    throw HostError(name + ": " + (said ? static_cast<const char*>(said->GetBufferPointer()) : "does not compile"));
  }
  return code;
}

std::string keyOf(const std::string& file, const Defines& defines) {
  std::string key = file;
  for (const std::string& define : defines) key += " " + define;
  return key;
}

} // namespace

const Features& D3d11Backend::features() {
  if (open_) return features_;
  open_ = true;
  ID3D11Device* on = device().get();
  features_.dualSourceBlending = true;
  features_.sampleRateShading = true;
  features_.stencil = true;
  features_.bindingBytes = std::uint64_t{1} << 29U;
  for (const std::uint32_t count : {2U, 4U, 8U}) {
    UINT colors = 0;
    UINT depths = 0;
    on->CheckMultisampleQualityLevels(DXGI_FORMAT_R32G32B32A32_FLOAT, count, &colors);
    on->CheckMultisampleQualityLevels(DXGI_FORMAT_D32_FLOAT, count, &depths);
    if (colors > 0 && depths > 0) features_.multisampled.push_back(count);
  }
  return features_;
}

VitrailD3d11ContextDesc D3d11Backend::contextDesc() {
  VitrailD3d11ContextDesc desc{};
  desc.device = device().get();
  desc.log = [](VitrailLogSeverity severity, const char* message, void* self) {
    static_cast<D3d11Backend*>(self)->log_.push_back({severity, message});
  };
  desc.logUser = this;
  return desc;
}

VitrailD3d11Context D3d11Backend::context() {
  if (context_ != nullptr) return context_;
  const VitrailD3d11ContextDesc desc = contextDesc();
  if (vitrailD3d11CreateContext(&desc, &context_) != VITRAIL_SUCCESS) throw HostError("vitrailD3d11CreateContext");
  return context_;
}

std::unique_ptr<PointHost> D3d11Backend::makeHost(const HostDesc& desc) {
  return std::make_unique<D3d11Host>(*this, desc);
}

VitrailTileLimits D3d11Backend::tileLimits(VitrailNodeFormat format, std::uint32_t samples) {
  VitrailTileLimits limits{};
  if (vitrailD3d11TileLimits(context(), format, samples, &limits) != VITRAIL_SUCCESS) {
    throw HostError("vitrailD3d11TileLimits");
  }
  return limits;
}

std::vector<LogLine> D3d11Backend::takeLog() { return std::exchange(log_, {}); }

std::vector<std::string> D3d11Backend::takeErrors() {
  std::vector<std::string> errors;
  for (const LogLine& line : takeLog()) errors.push_back("the library's log: " + line.text);
  if (open_ && FAILED(device().get()->GetDeviceRemovedReason())) errors.emplace_back("the device was removed");
  return errors;
}

void D3d11Backend::close() {
  pixelShaders_.clear();
  computeShaders_.clear();
  vertexShaders_.clear();
  pointLayout_ = {};
  vitrailD3d11DestroyContext(std::exchange(context_, nullptr));
}

ID3D11PixelShader* D3d11Backend::pixelShader(const std::string& file, const Defines& defines) {
  Com<ID3D11PixelShader>& kept = pixelShaders_[keyOf(file, defines)];
  if (!kept) {
    const Com<ID3DBlob> code = compile(file, "main", "ps_5_0", defines);
    check(device().get()->CreatePixelShader(code->GetBufferPointer(), code->GetBufferSize(), nullptr, kept.out()),
          "CreatePixelShader");
  }
  return kept.get();
}

ID3D11ComputeShader* D3d11Backend::computeShader(const std::string& file, const Defines& defines) {
  Com<ID3D11ComputeShader>& kept = computeShaders_[keyOf(file, defines)];
  if (!kept) {
    const Com<ID3DBlob> code = compile(file, "main", "cs_5_0", defines);
    check(device().get()->CreateComputeShader(code->GetBufferPointer(), code->GetBufferSize(), nullptr, kept.out()),
          "CreateComputeShader");
  }
  return kept.get();
}

ID3D11VertexShader* D3d11Backend::vertexShader(const std::string& file) {
  Com<ID3D11VertexShader>& kept = vertexShaders_[file];
  if (!kept) {
    const Com<ID3DBlob> code = compile(file, "place", "vs_5_0", {});
    check(device().get()->CreateVertexShader(code->GetBufferPointer(), code->GetBufferSize(), nullptr, kept.out()),
          "CreateVertexShader");
  }
  return kept.get();
}

ID3D11InputLayout* D3d11Backend::pointLayout() {
  if (!pointLayout_) {
    const Com<ID3DBlob> code = compile("points", "place", "vs_5_0", {});
    constexpr UINT kNext = D3D11_APPEND_ALIGNED_ELEMENT;
    constexpr auto kVertex = D3D11_INPUT_PER_VERTEX_DATA;
    constexpr std::array<D3D11_INPUT_ELEMENT_DESC, 4> kElements = {{
        {"POSITION", 0, DXGI_FORMAT_R32G32B32_FLOAT, 0, 0, kVertex, 0},
        {"COLOR", 0, DXGI_FORMAT_R32G32B32A32_FLOAT, 0, kNext, kVertex, 0},
        {"BLEND", 0, DXGI_FORMAT_R32_UINT, 0, kNext, kVertex, 0},
        {"WORD", 0, DXGI_FORMAT_R32_UINT, 0, kNext, kVertex, 0},
    }};
    check(device().get()->CreateInputLayout(kElements.data(), kElements.size(), code->GetBufferPointer(),
                                            code->GetBufferSize(), pointLayout_.out()),
          "CreateInputLayout");
  }
  return pointLayout_.get();
}

D3d11Backend& backend() { return Registered<D3d11Backend>::get(); }

void D3d11Test::TearDown() {
  for (const std::string& error : backend().takeErrors()) ADD_FAILURE() << error;
}

} // namespace vitrail::tests::d3d11
