// Mist: homogeneous volumes that scatter.
