// What rays that leave the scene see.
