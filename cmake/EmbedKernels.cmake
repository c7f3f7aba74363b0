# Embeds every file of kernels/ into a library as {path, text} pairs; the host expands the includes.
function(sundog_embed_kernels target)
endfunction()
