// Compiles HLSL with Microsoft's compilers, whose libraries lie beside this program: d3dcompiler_47.dll up to shader
// model 5.1, dxcompiler.dll from 6.0 on. What the Windows SDK's fxc.exe and dxc.exe do, for builds under Wine.
//
//   compile OUT PROFILE ENTRY IN [-I FOLDER]... [-D NAME=VALUE]... [-W]
//
// OUT gets the bytecode as numbers with commas between them, for an array. -W: warnings are errors.
#include <d3dcompiler.h>
#include <windows.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Options {
  std::string out;
  std::string profile;
  std::string entry;
  std::string in;
  std::vector<std::string> folders;
  std::vector<std::string> defines;
  bool warningsAreErrors = false;
};

bool readFile(const std::string& name, std::string& text) {
  std::ifstream file(name, std::ios::binary);
  text.assign(std::istreambuf_iterator<char>(file), {});
  return static_cast<bool>(file);
}

std::string folderOf(const std::string& name) { return name.substr(0, name.find_last_of("/\\") + 1); }

// The text with everything that it includes, beside it or in the folders, in its place: both compilers take that.
// Include guards work as ever; a file that is not found stays for the compiler to complain of.
std::string flattened(const std::string& name, const std::string& text, const std::vector<std::string>& folders) {
  std::string result = "#line 1 \"" + name + "\"\n";
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t begin = line.find('"');
    const std::size_t end = line.find('"', begin + 1);
    bool found = false;
    if (line.rfind("#include", 0) == 0 && end != std::string::npos) {
      const std::string included = line.substr(begin + 1, end - begin - 1);
      std::vector<std::string> places = folders;
      places.insert(places.begin(), folderOf(name));
      for (const std::string& folder : places) {
        const std::string place = folder.empty() || folder.back() == '/' ? folder : folder + "/";
        std::string more;
        found = readFile(place + included, more);
        if (!found) continue;
        result += flattened(place + included, more, folders);
        result += "#line " + std::to_string(number + 1) + " \"" + name + "\"\n";
        break;
      }
    }
    if (!found) result += line + "\n";
  }
  return result;
}

bool readSource(const Options& options, std::string& source) {
  std::string text;
  if (!readFile(options.in, text)) return false;
  source = flattened(options.in, text, options.folders);
  return true;
}

bool compileOld(const Options& options, std::string& code) {
  std::string source;
  if (!readSource(options, source)) return false;
  std::vector<std::pair<std::string, std::string>> defines;
  for (const std::string& define : options.defines) {
    const std::size_t equals = define.find('=');
    defines.emplace_back(define.substr(0, equals), equals == std::string::npos ? "1" : define.substr(equals + 1));
  }
  std::vector<D3D_SHADER_MACRO> macros;
  for (const auto& [name, value] : defines) macros.push_back({name.c_str(), value.c_str()});
  macros.push_back({nullptr, nullptr});
  UINT flags = D3DCOMPILE_OPTIMIZATION_LEVEL3;
  if (options.warningsAreErrors) flags |= D3DCOMPILE_WARNINGS_ARE_ERRORS;
  ID3DBlob* made = nullptr;
  ID3DBlob* said = nullptr;
  const HRESULT result = D3DCompile(source.data(), source.size(), options.in.c_str(), macros.data(), nullptr,
                                    options.entry.c_str(), options.profile.c_str(), flags, 0, &made, &said);
  if (said != nullptr && (FAILED(result) || options.warningsAreErrors)) {
    std::fprintf(stderr, "%s", static_cast<const char*>(said->GetBufferPointer()));
  }
  if (FAILED(result)) return false;
  code.assign(static_cast<const char*>(made->GetBufferPointer()), made->GetBufferSize());
  return true;
}

} // namespace

// ---- dxcompiler.dll, as far as it is needed of dxcapi.h, which MinGW has not. Not in the unnamed namespace: there GCC
// knows that nobody implements these interfaces.

struct DxcBuffer {
  const void* data;
  SIZE_T size;
  UINT encoding;
};
struct IDxcBlob : IUnknown {
  virtual LPVOID STDMETHODCALLTYPE GetBufferPointer() = 0;
  virtual SIZE_T STDMETHODCALLTYPE GetBufferSize() = 0;
};
struct IDxcResult : IUnknown {
  virtual HRESULT STDMETHODCALLTYPE GetStatus(HRESULT*) = 0;
  virtual HRESULT STDMETHODCALLTYPE GetResult(IDxcBlob**) = 0;
  virtual HRESULT STDMETHODCALLTYPE GetErrorBuffer(IDxcBlob**) = 0;
};
struct IDxcCompiler3 : IUnknown {
  virtual HRESULT STDMETHODCALLTYPE Compile(const DxcBuffer*, LPCWSTR*, UINT, IUnknown*, REFIID, LPVOID*) = 0;
};

namespace {

constexpr GUID kCompilerClass = {0x73e22d93, 0xe6ce, 0x47f3, {0xb5, 0xbf, 0xf0, 0x66, 0x4f, 0x39, 0xc1, 0xb0}};
constexpr GUID kCompiler3 = {0x228b4687, 0x5a6a, 0x4730, {0x90, 0x0c, 0x97, 0x02, 0xb2, 0x20, 0x3f, 0x54}};
constexpr GUID kResult = {0xcedb484a, 0xd4e9, 0x445a, {0xb9, 0x91, 0xca, 0x21, 0xca, 0x15, 0x7d, 0xc2}};
constexpr UINT kUtf8 = 65001;
using DxcCreateInstance = HRESULT(WINAPI*)(REFCLSID, REFIID, LPVOID*);

bool compileNew(const Options& options, std::string& code) {
  std::string source;
  if (!readSource(options, source)) return false;
  const HMODULE library = LoadLibraryA("dxcompiler.dll");
  if (library == nullptr) return false;
  const auto create =
      reinterpret_cast<DxcCreateInstance>(reinterpret_cast<void*>(GetProcAddress(library, "DxcCreateInstance")));
  IDxcCompiler3* compiler = nullptr;
  if (create == nullptr || FAILED(create(kCompilerClass, kCompiler3, reinterpret_cast<void**>(&compiler))))
    return false;
  std::vector<std::string> words = {options.in, "-E", options.entry, "-T", options.profile};
  for (const std::string& define : options.defines) words.insert(words.end(), {"-D", define});
  if (options.warningsAreErrors) words.emplace_back("-WX");
  std::vector<std::wstring> wide;
  for (const std::string& word : words) wide.emplace_back(word.begin(), word.end());
  std::vector<LPCWSTR> arguments;
  for (const std::wstring& word : wide) arguments.push_back(word.c_str());
  const DxcBuffer buffer{source.data(), source.size(), kUtf8};
  IDxcResult* result = nullptr;
  HRESULT status = compiler->Compile(&buffer, arguments.data(), static_cast<UINT>(arguments.size()), nullptr, kResult,
                                     reinterpret_cast<void**>(&result));
  if (SUCCEEDED(status)) result->GetStatus(&status);
  IDxcBlob* said = nullptr;
  if (result != nullptr && SUCCEEDED(result->GetErrorBuffer(&said)) && said != nullptr && said->GetBufferSize() > 1) {
    std::fprintf(stderr, "%s\n", static_cast<const char*>(said->GetBufferPointer()));
  }
  IDxcBlob* made = nullptr;
  if (FAILED(status) || FAILED(result->GetResult(&made))) return false;
  code.assign(static_cast<const char*>(made->GetBufferPointer()), made->GetBufferSize());
  return true;
}

bool writeNumbers(const std::string& name, const std::string& code) {
  std::string text;
  for (std::size_t i = 0; i < code.size(); ++i) {
    text += std::to_string(static_cast<unsigned char>(code[i]));
    text += i % 32 == 31 ? ",\n" : ",";
  }
  text += '\n';
  std::ofstream file(name, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  return static_cast<bool>(file.flush());
}

} // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr, "compile OUT PROFILE ENTRY IN [-I FOLDER]... [-D NAME=VALUE]... [-W]\n");
    return 2;
  }
  Options options{words[1], words[2], words[3], words[4], {}, {}, false};
  for (int i = 5; i < count; ++i) {
    const std::string word = words[i];
    if (word == "-W") options.warningsAreErrors = true;
    if (word == "-I" && i + 1 < count) options.folders.emplace_back(words[++i]);
    if (word == "-D" && i + 1 < count) options.defines.emplace_back(words[++i]);
  }
  const bool isNew = options.profile.find("_6_") != std::string::npos;
  std::string code;
  const bool made = isNew ? compileNew(options, code) : compileOld(options, code);
  if (made && writeNumbers(options.out, code)) return 0;
  std::fprintf(stderr, "%s: no %s of %s\n", options.in.c_str(), options.profile.c_str(), options.entry.c_str());
  std::remove(options.out.c_str());
  return 1;
}
