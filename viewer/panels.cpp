#include "panels.h"

#include <imgui.h>
#include <backends/imgui_impl_sdl.h>
#include <backends/imgui_impl_vulkan.h>

static const float MARGIN = 8.0f; /* pixels */
static const ImGuiWindowFlags bare =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

extern "C" bool viewer_panels_init(const struct viewer_panels_setup *setup, VkCommandBuffer upload)
{
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4.0f;
    ImGui::GetStyle().WindowBorderSize = 0.0f;

    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = setup->vulkan.instance;
    info.PhysicalDevice = setup->vulkan.physical_device;
    info.Device = setup->vulkan.device;
    info.QueueFamily = setup->vulkan.queue_family;
    info.Queue = setup->vulkan.queue;
    info.DescriptorPool = setup->descriptors;
    info.MinImageCount = setup->image_count < 2 ? 2 : setup->image_count;
    info.ImageCount = info.MinImageCount;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    return ImGui_ImplSDL2_InitForVulkan(setup->window) &&
           ImGui_ImplVulkan_Init(&info, setup->render_pass) &&
           ImGui_ImplVulkan_CreateFontsTexture(upload);
}

extern "C" void viewer_panels_uploaded(void)
{
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

extern "C" void viewer_panels_event(const SDL_Event *event)
{
    ImGui_ImplSDL2_ProcessEvent(event);
}

/* Text that is wider than the window is wrapped at words. */
static void panel(const char *name, const char *text, ImVec2 place, ImVec2 pivot)
{
    if (!text)
        return;
    const float around = 2.0f * (MARGIN + ImGui::GetStyle().WindowPadding.x);
    const float width = ImGui::GetIO().DisplaySize.x - around;
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowBgAlpha(0.6f);
    if (ImGui::Begin(name, nullptr, bare)) {
        ImGui::PushTextWrapPos(ImGui::GetStyle().WindowPadding.x + (width > 1.0f ? width : 1.0f));
        ImGui::TextUnformatted(text);
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

extern "C" void viewer_panels_draw(const struct viewer_panels_content *content,
                                   VkCommandBuffer commands)
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    panel("status", content->status, ImVec2(MARGIN, size.y - MARGIN), ImVec2(0.0f, 1.0f));
    panel("notice", content->notice, ImVec2(size.x - MARGIN, MARGIN), ImVec2(1.0f, 0.0f));
    panel("times", content->times, ImVec2(MARGIN, MARGIN), ImVec2(0.0f, 0.0f));
    panel("help", content->help, ImVec2(size.x * 0.5f, size.y * 0.5f), ImVec2(0.5f, 0.5f));
    ImGui::Render();
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

extern "C" void viewer_panels_finish(void)
{
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplSDL2_Shutdown();
    ImGui::DestroyContext();
}
