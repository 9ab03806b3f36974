"""Pictures: matplotlib figures, svg and png, that colour-blind people and grey printers can read."""
