-- RSL in Neovim: put this file into ~/.config/nvim/plugin/. It needs `rsc` in PATH.
-- For Neovim 0.7 and newer; no plugin is needed.

vim.filetype.add({ extension = { rsl = "rsl" } })

-- The client that is there already for this folder, or a new one (vim.lsp.start does that from 0.8 on).
local function start(config, buffer)
  if vim.lsp.start then
    return vim.lsp.start(config, { bufnr = buffer })
  end
  for _, client in pairs(vim.lsp.get_active_clients()) do
    if client.name == config.name and client.config.root_dir == config.root_dir then
      return vim.lsp.buf_attach_client(buffer, client.id)
    end
  end
  vim.lsp.buf_attach_client(buffer, vim.lsp.start_client(config))
end

vim.api.nvim_create_autocmd("FileType", {
  pattern = { "rsl", "json" },
  callback = function(event)
    local path = vim.api.nvim_buf_get_name(event.buf)
    local folder = vim.fn.fnamemodify(path, ":p:h")
    -- Of JSON files only those that belong to a program.
    if event.match == "json" and vim.fn.glob(folder .. "/*.rsl") == "" then
      return
    end
    if event.match == "rsl" then
      vim.bo[event.buf].commentstring = "% %s"
      vim.bo[event.buf].shiftwidth = 2
      vim.bo[event.buf].expandtab = true
      vim.bo[event.buf].omnifunc = "v:lua.vim.lsp.omnifunc"
    end
    start({ name = "rsl", cmd = { "rsc", "lsp" }, root_dir = folder }, event.buf)
  end,
})
