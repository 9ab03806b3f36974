"""What loaders of other people's files share: safe reading, textures, cleaning, orientation, a process of its own."""
