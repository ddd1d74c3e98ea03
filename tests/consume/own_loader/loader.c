#include "loader.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

#define DEFINE(name) PFN_##name name;
EACH_FUNCTION(DEFINE)
#undef DEFINE

PFN_vkGetInstanceProcAddr openLoader(void) {
  const char* name = "libvulkan.so.1";
  if (dlopen(name, RTLD_NOW | RTLD_NOLOAD) != NULL) return NULL;
  void* library = dlopen(name, RTLD_NOW);
  if (library == NULL) return NULL;
  void* symbol = dlsym(library, "vkGetInstanceProcAddr");
  PFN_vkGetInstanceProcAddr function;
  memcpy(&function, &symbol, sizeof function); /* C has no cast from an object to a function */
  return function;
}

void loadFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
#define LOAD(name) name = (PFN_##name)getInstanceProcAddr(instance, #name);
  EACH_FUNCTION(LOAD)
#undef LOAD
}
